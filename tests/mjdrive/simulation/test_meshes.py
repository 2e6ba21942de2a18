import mujoco
import numpy as np
import pytest
import shapely

from mjdrive.simulation.meshes import Shell

SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]])


def triangles(shell: Shell) -> np.ndarray:
    """Corners of the triangles that MuJoCo gets, shape (N, 3, 3) [m]."""
    spec = mujoco.MjSpec()
    assert shell.mesh(spec, "m")
    mesh = spec.mesh("m")
    points = np.array(mesh.uservert).reshape(-1, 3)
    return points[np.array(mesh.userface).reshape(-1, 3)]


def volume(corners: np.ndarray) -> float:
    """Signed volume that closed faces enclose: positive if all of them look outwards."""
    first, second, third = np.moveaxis(corners, 1, 0)
    return float(np.sum(first * np.cross(second, third)) / 6.0)


def normals(corners: np.ndarray) -> np.ndarray:
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return crossed / np.linalg.norm(crossed, axis=1, keepdims=True)


def area(corners: np.ndarray) -> float:
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return float(0.5 * np.linalg.norm(crossed, axis=1).sum())


def test_box_is_closed_and_looks_outwards():
    shell = Shell()
    shell.box(SQUARE, bottom=1.0, top=4.0, floor=True)
    assert volume(triangles(shell)) == pytest.approx(2.0 * 1.0 * 3.0)


def test_prism_of_many_sides_is_closed_too():
    angle = np.arange(7) * 2 * np.pi / 7
    outline = np.column_stack([np.cos(angle), np.sin(angle)])
    shell = Shell(decimals=6)
    shell.box(outline, bottom=0.0, top=1.0, floor=True)
    expected = 3.5 * np.sin(2 * np.pi / 7)
    assert volume(triangles(shell)) == pytest.approx(expected, abs=1e-5)


def test_area_with_a_hole_is_covered_once_and_faces_the_sky():
    hole = shapely.box(0, 0, 10, 10) - shapely.box(2, 3, 6, 5)
    shell = Shell()
    shell.area(hole, height=0.5)
    corners = triangles(shell)
    assert area(corners) == pytest.approx(100.0 - 8.0)
    assert normals(corners)[:, 2] == pytest.approx(1.0)
    assert corners[..., 2] == pytest.approx(0.5)


def test_fence_looks_to_the_right_of_its_line():
    shell = Shell()
    shell.fence(np.array([[0.0, 0.0], [5.0, 0.0]]), bottom=0.0, top=2.0)
    corners = triangles(shell)
    assert area(corners) == pytest.approx(10.0)
    assert normals(corners) == pytest.approx(np.array([[0.0, -1.0, 0.0]] * 2))


def test_nothing_to_show_makes_no_mesh():
    spec = mujoco.MjSpec()
    shell = Shell()
    shell.area(shapely.Polygon(), height=0.0)
    shell.show(spec, "none", material="none")
    assert not spec.meshes
    assert not spec.geoms


def test_a_single_triangle_can_be_shown():
    shell = Shell()
    shell.polygon(np.array([[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [0.0, 1.0, 1.0]]))
    spec = mujoco.MjSpec()
    shell.show(spec, "m", material="")
    assert spec.compile().ngeom == 1


def test_faces_without_area_are_not_shown():
    shell = Shell()
    shell.fence(np.array([[0.0, 0.0], [0.0001, 0.0], [0.0002, 0.0]]), bottom=0.0, top=1.0)
    spec = mujoco.MjSpec()
    shell.show(spec, "m", material="")
    assert spec.compile().ngeom == 0
