import mujoco
import numpy as np
import pytest
import shapely

from mjdrive.simulation.facades import DOOR, PROUD, add_houses
from mjdrive.simulation.palette import add_materials
from mjdrive.simulation.roofs import CORNICE, EAVES, HIGHEST_GABLE
from mjdrive.simulation.walls import walls_of
from mjdrive.town.scenery.blocks import Block

HOUSE = Block(x=30.0, y=-20.0, yaw=0.6, length=15.0, depth=9.0, height=13.0)
COTTAGE = Block(x=30.0, y=-20.0, yaw=0.6, length=12.0, depth=9.0, height=6.0)


def built(house: Block, seed: int = 0) -> mujoco.MjModel:
    spec = mujoco.MjSpec()
    add_materials(spec)
    add_houses(spec, [house], rng=np.random.default_rng(seed))
    return spec.compile()


def points_of(model: mujoco.MjModel, prefix: str) -> np.ndarray:
    """World points of all meshes whose name starts so, shape (N, 3) [m]."""
    found = []
    for index in range(model.ngeom):
        geom = model.geom(index)
        if geom.name.startswith(prefix) and geom.type[0] == mujoco.mjtGeom.mjGEOM_MESH:
            mesh = model.mesh(geom.dataid[0])
            turn = np.empty(9)
            mujoco.mju_quat2Mat(turn, geom.quat)
            points = model.mesh_vert[mesh.vertadr[0] :][: mesh.vertnum[0]]
            found.append(points @ turn.reshape(3, 3).T + geom.pos)
    return np.concatenate(found)


def test_walls_go_round_the_house_with_its_front_first():
    walls = walls_of(HOUSE)
    front = 0.5 * walls[0].width * walls[0].forward + walls[0].start - [HOUSE.x, HOUSE.y]
    left = np.array([-np.sin(HOUSE.yaw), np.cos(HOUSE.yaw)])
    assert front == pytest.approx(0.5 * HOUSE.depth * left)
    assert [wall.width for wall in walls] == pytest.approx([15.0, 9.0, 15.0, 9.0])


def test_panels_look_away_from_the_house():
    for wall in walls_of(HOUSE):
        first, second, third, _ = wall.panel(1.0, 3.0, 0.5, 2.0, proud=0.1)
        outward = np.cross(second - first, third - second)[:2]
        middle = wall.start + 0.5 * wall.width * wall.forward
        assert outward @ (middle - [HOUSE.x, HOUSE.y]) > 0.0


@pytest.mark.parametrize("house", [HOUSE, COTTAGE])
def test_windows_and_doors_hang_on_the_walls(house):
    walls = house.footprint().exterior
    for kind in ("facade_windows", "facade_doors"):
        points = points_of(built(house), kind)
        assert shapely.distance(walls, shapely.points(points[:, :2])).max() < PROUD + 0.002
        assert points[:, 2].min() >= -1e-6
        assert points[:, 2].max() < house.height


def test_the_door_is_in_the_front():
    points = points_of(built(HOUSE), "facade_doors")
    front = walls_of(HOUSE)[0]
    along = (points[:, :2] - front.start) @ front.forward
    assert np.ptp(along) == pytest.approx(DOOR[0], abs=0.01)
    assert 0.0 < along.min() < along.max() < front.width
    assert np.ptp(points[:, 2]) == pytest.approx(DOOR[1], abs=0.01)


@pytest.mark.parametrize(("house", "overhang"), [(HOUSE, CORNICE[0]), (COTTAGE, EAVES)])
def test_roof_covers_the_house_and_little_more(house, overhang):
    points = points_of(built(house), "roofs")
    roof = shapely.MultiPoint(points[:, :2]).convex_hull
    assert roof.contains(house.footprint())
    assert house.footprint().buffer(overhang + 0.01, join_style="mitre").contains(roof)
    assert points[:, 2].max() > house.height


def test_low_houses_have_a_ridge_along_their_longer_side():
    points = points_of(built(COTTAGE), "roofs")
    assert COTTAGE.height < HIGHEST_GABLE
    ridge = points[points[:, 2] > points[:, 2].max() - 0.01]
    along = np.array([np.cos(COTTAGE.yaw), np.sin(COTTAGE.yaw)])
    spread = (ridge[:, :2] - [COTTAGE.x, COTTAGE.y]) @ along
    assert np.ptp(spread) == pytest.approx(COTTAGE.length + 2 * EAVES, abs=0.01)


def test_same_seed_gives_the_same_colours():
    first, again = built(HOUSE, 3), built(HOUSE, 3)
    assert np.array_equal(first.geom_matid, again.geom_matid)
    colours = {int(built(HOUSE, seed).geom_matid[0]) for seed in range(12)}
    assert len(colours) > 2
