"""Surfaces for the eye only: many faces of one material become one mesh, which costs the physics nothing."""

import functools
from collections.abc import Iterator

import mujoco
import numpy as np
import shapely
from jaxtyping import Float

from mjdrive.simulation.blocks import SHOWN_GROUP

DECIMALS = 3  # of vertices and texture: millimetres keep scene.xml short and free of rounding noise
SMALLEST_AREA = 1e-9  # MuJoCo refuses meshes without area [m^2]


class Shell:
    """Faces of one material.

    Args:
        decimals: Digits of a metre that vertices keep; 2 is enough for what is seen from afar.
    """

    def __init__(self, *, decimals: int = DECIMALS) -> None:
        self._decimals = decimals
        self._vertices: list[Float[np.ndarray, "_ 3"]] = []
        self._texture: list[Float[np.ndarray, "_ 2"]] = []
        self._faces: list[np.ndarray] = []
        self._num_vertices = 0

    def add(
        self,
        vertices: Float[np.ndarray, "N 3"],
        faces: np.ndarray,
        *,
        texture: Float[np.ndarray, "N 2"] | None = None,
    ) -> None:
        """Add triangles that share vertices, as smooth surfaces do.

        Args:
            vertices: World frame [m].
            faces: Indices of three vertices each, counter-clockwise from outside, shape (M, 3).
            texture: Place of each vertex in the texture, if the material has one [-].
        """
        self._faces.append(np.asarray(faces) + self._num_vertices)
        self._vertices.append(np.asarray(vertices, float))
        self._texture.append(np.zeros((0, 2)) if texture is None else texture)
        self._num_vertices += len(vertices)

    def polygon(
        self, corners: Float[np.ndarray, "N 3"], *, texture: Float[np.ndarray, "N 2"] | None = None
    ) -> None:
        """Add one flat convex face with edges of its own.

        Args:
            corners: Counter-clockwise from outside, world frame [m].
            texture: Place of each corner in the texture, if the material has one [-].
        """
        self.add(corners, _fan(len(corners)), texture=texture)

    def area(
        self, area: shapely.Geometry, *, height: float, texture_size: float | None = None
    ) -> None:
        """Add flat ground that looks to the sky.

        Args:
            area: Polygon or several, holes allowed, world frame [m].
            height: Above the road [m].
            texture_size: Side of a square that the texture of the material fills, if it has one [m].
        """
        tidy = shapely.set_precision(area, 10.0**-self._decimals)
        triangles = [
            triangle
            for part in _without_holes(tidy)
            for triangle in shapely.get_parts(shapely.constrained_delaunay_triangles(part))
        ]
        if not triangles:
            return
        corners = [shapely.get_coordinates(shapely.orient_polygons(part))[:3] for part in triangles]
        points, faces = np.unique(
            np.concatenate(corners).round(self._decimals), axis=0, return_inverse=True
        )
        texture = None if texture_size is None else points / texture_size
        self.add(_at(points, height), faces.reshape(-1, 3), texture=texture)

    def fence(self, line: Float[np.ndarray, "N 2"], *, bottom: float, top: float) -> None:
        """Add upright faces along a line, which look to its right.

        Args:
            line: World frame [m].
            bottom: Above the road [m].
            top: Above the road [m].
        """
        num_points = len(line)
        vertices = np.concatenate([_at(line, bottom), _at(line, top)])
        self.add(vertices, _strip(num_points))

    def box(
        self, footprint: Float[np.ndarray, "N 2"], *, bottom: float, top: float, floor: bool = False
    ) -> None:
        """Add an upright prism.

        Args:
            footprint: Convex outline, counter-clockwise, last point not repeated, world frame [m].
            bottom: Above the road [m].
            top: Above the road [m].
            floor: Whether it is seen from below.
        """
        num_points = len(footprint)
        closed = _strip(num_points + 1)
        top_ring = closed > num_points
        sides = np.where(
            top_ring, num_points + (closed - 1 - num_points) % num_points, closed % num_points
        )
        fan = _fan(num_points)
        faces = [sides, fan + num_points, *([fan[:, ::-1]] if floor else [])]
        self.add(
            np.concatenate([_at(footprint, bottom), _at(footprint, top)]), np.concatenate(faces)
        )

    def mesh(self, spec: mujoco.MjSpec, name: str) -> bool:
        """Make a mesh of the faces, to be shown by as many geoms as one likes.

        Args:
            spec: Scene to add to.
            name: Of the mesh.

        Returns:
            Whether there was any face with an area to make a mesh of.
        """
        if not self._faces:
            return False
        vertices = np.concatenate(self._vertices).round(self._decimals)
        faces = np.concatenate(self._faces)
        if _area(vertices, faces) < SMALLEST_AREA:
            return False
        texture = np.concatenate(self._texture)
        assert len(texture) in (0, self._num_vertices), "texture on some faces only"
        if self._num_vertices == 3:
            # MuJoCo wants four vertices: a single triangle has its last one twice.
            vertices, texture = (np.concatenate([rows, rows[-1:]]) for rows in (vertices, texture))
        spec.add_mesh(
            name=name,
            uservert=vertices.ravel().tolist(),
            userface=faces.ravel().tolist(),
            usertexcoord=texture.round(DECIMALS).ravel().tolist(),
            inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
        )
        return True

    def show(self, spec: mujoco.MjSpec, name: str, *, material: str) -> None:
        """Show the faces as one mesh; nothing if there are none.

        Args:
            spec: Scene to add to.
            name: Of mesh and geom.
            material: Of the scene.
        """
        if self.mesh(spec, name):
            show_mesh(spec, name, mesh=name, material=material)


def _area(vertices: Float[np.ndarray, "N 3"], faces: np.ndarray) -> float:
    """Area of all triangles together [m^2]."""
    first, second, third = vertices[faces].swapaxes(0, 1)
    return float(0.5 * np.linalg.norm(np.cross(second - first, third - first), axis=1).sum())


def _at(points: Float[np.ndarray, "N 2"], height: float) -> Float[np.ndarray, "N 3"]:
    return np.column_stack([points, np.full(len(points), height)])


def _without_holes(area: shapely.Geometry) -> Iterator[shapely.Polygon]:
    """Cut an area through its holes: GEOS cannot triangulate around every hole that touches the outline."""
    for part in shapely.get_parts(area):
        if part.geom_type != "Polygon":
            continue  # what cuts leave of edges
        if not part.interiors:
            yield part
            continue
        left, bottom, right, top = part.bounds
        cut = part.interiors[0].centroid.x
        for half in (shapely.box(left, bottom, cut, top), shapely.box(cut, bottom, right, top)):
            yield from _without_holes(shapely.intersection(part, half))


@functools.cache
def _fan(num_points: int) -> np.ndarray:
    """Triangles of a convex polygon."""
    faces = np.array([[0, last - 1, last] for last in range(2, num_points)])
    faces.setflags(write=False)
    return faces


def _strip(num_points: int) -> np.ndarray:
    """Triangles between a lower line of so many points and an upper one."""
    low = np.arange(num_points - 1)
    high = low + num_points
    return np.concatenate(
        [np.stack([low, low + 1, high], axis=1), np.stack([low + 1, high + 1, high], axis=1)]
    )


def show_mesh(
    spec: mujoco.MjSpec,
    name: str,
    *,
    mesh: str,
    material: str,
    position: Float[np.ndarray, "3"] | None = None,
    quaternion: list[float] | None = None,
) -> None:
    """Show a mesh that nothing collides with.

    Args:
        spec: Scene to add to.
        name: Of the geom.
        mesh: Of the scene.
        material: Of the scene.
        position: Of the origin of the mesh, world frame [m]; the origin of the world if None.
        quaternion: Its turn; none if None [-].
    """
    spec.worldbody.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_MESH,
        meshname=mesh,
        pos=np.zeros(3) if position is None else np.asarray(position).round(DECIMALS),
        quat=quaternion or [1.0, 0.0, 0.0, 0.0],
        contype=0,
        conaffinity=0,
        group=SHOWN_GROUP,
        material=material,
    )
