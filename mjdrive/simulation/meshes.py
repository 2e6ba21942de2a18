"""Flat surfaces as triangle meshes, for the eye only."""

from collections.abc import Sequence

import mujoco
import numpy as np
import shapely
from jaxtyping import Float

from mjdrive.simulation.blocks import DECIMALS, SHOWN_GROUP


def add_area(
    spec: mujoco.MjSpec, name: str, area: shapely.Geometry, *, height: float, rgba: Sequence[float]
) -> None:
    """Show a flat area.

    Args:
        spec: Scene to add to.
        name: Of mesh and geom.
        area: Polygon or several, holes allowed, world frame [m].
        height: Above the ground [m].
        rgba: Colour [-].
    """
    triangles = shapely.get_parts(shapely.constrained_delaunay_triangles(area))
    corners = [shapely.get_coordinates(shapely.orient_polygons(part))[:3] for part in triangles]
    _add(spec, name, np.array(corners).reshape(-1, 3, 2), height=height, rgba=rgba)


def add_quads(
    spec: mujoco.MjSpec,
    name: str,
    quads: Sequence[Float[np.ndarray, "4 2"]],
    *,
    height: float,
    rgba: Sequence[float],
) -> None:
    """Show many flat quadrilaterals as one mesh; nothing if there are none.

    Args:
        spec: Scene to add to.
        name: Of mesh and geom.
        quads: Corners of each, counter-clockwise, world frame [m].
        height: Above the ground [m].
        rgba: Colour [-].
    """
    if quads:
        triangles = np.concatenate([np.array(quads)[:, [0, 1, 2]], np.array(quads)[:, [0, 2, 3]]])
        _add(spec, name, triangles, height=height, rgba=rgba)


def _add(
    spec: mujoco.MjSpec,
    name: str,
    triangles: Float[np.ndarray, "N 3 2"],
    *,
    height: float,
    rgba: Sequence[float],
) -> None:
    points, faces = np.unique(triangles.reshape(-1, 2).round(DECIMALS), axis=0, return_inverse=True)
    vertices = np.column_stack([points, np.full(len(points), height)])
    spec.add_mesh(
        name=name,
        uservert=vertices.ravel().tolist(),
        userface=faces.ravel().tolist(),
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )
    spec.worldbody.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_MESH,
        meshname=name,
        contype=0,
        conaffinity=0,
        group=SHOWN_GROUP,
        rgba=rgba,
    )
