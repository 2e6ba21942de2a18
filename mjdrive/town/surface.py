"""The ground that lanes and roads cover, as polygons."""

from collections.abc import Collection, Mapping
from functools import lru_cache
from types import MappingProxyType

import numpy as np
import shapely
from jaxtyping import Float
from shapely.geometry import LineString, MultiPolygon, Polygon

from mjdrive.datatypes import Lane, Town
from mjdrive.geometry import offset_polyline

_SEAM = 0.01
"""Cracks between lanes that count as rounding, not as gaps [m]."""

_SMALLEST_ISLAND = 5.0
"""Islands below this area are paint at best, wherever they lie [m^2]."""

_SMALLEST_BLOCK = 300.0
"""Islands from this area on are no leftovers between turning lanes, wherever they lie [m^2]."""

_RUNS_BESIDE = 8.0
"""A street that is near an island over this distance runs along it; the end of a lane is less wide [m]."""

_NARROWEST_NOTCH = 1.0
"""Kerbs do not follow notches narrower than this [m]."""

_KERB_TOLERANCE = 0.01
"""How far a straight kerb may lie from a curved edge: fewer, longer kerbs [m]."""

_THINNEST = 0.01
"""Width that a lane keeps in its polygon where it tapers to nothing [m]."""


_SHORTEST_LANE = 1e-6
"""A shorter lane is a point and covers no ground [m]."""


def edges(lane: Lane) -> tuple[Float[np.ndarray, "N 2"], Float[np.ndarray, "N 2"]]:
    """Draw both edges of a lane, in its direction of travel.

    Args:
        lane: The lane.

    Returns:
        Left and right edge, one point for each of the centre line, world frame, shape (N, 2) [m].
    """
    half = lane.width / 2 if lane.widths is None else lane.widths / 2
    return offset_polyline(lane.centerline, half), offset_polyline(lane.centerline, -half)


@lru_cache(maxsize=4)
def lane_polygons(town: Town) -> Mapping[str, Polygon]:
    """Outline each lane.

    Args:
        town: The town.

    Returns:
        The area of each lane by its name, world frame [m].
    """
    return MappingProxyType({name: outline(lane) for name, lane in town.lanes.items()})


@lru_cache(maxsize=4)
def driving_surface(town: Town) -> Polygon | MultiPolygon:
    """Join all lanes: where a car is on the road.

    Args:
        town: The town.

    Returns:
        Union of the lanes, world frame [m].
    """
    union = shapely.union_all(list(lane_polygons(town).values()))
    return union.buffer(_SEAM, join_style="mitre").buffer(-_SEAM, join_style="mitre")


@lru_cache(maxsize=8)
def road_surface(town: Town, shoulder: float = 0.3) -> Polygon | MultiPolygon:
    """Widen the lanes by the gutter: its boundary is where the kerbs stand.

    Junctions are one clean area: the leftovers between turning lanes belong to it. The island of a roundabout and
    a strip between the two directions of a road are none of these, however small.

    Args:
        town: The town.
        shoulder: Width of the gutter between lane and kerb [m].

    Returns:
        The road with city blocks and islands as holes, world frame [m].
    """
    surface = driving_surface(town)
    wide = surface.buffer(shoulder + _NARROWEST_NOTCH / 2).buffer(-_NARROWEST_NOTCH / 2)
    tree = shapely.STRtree(list(lane_polygons(town).values()))
    lanes = list(town.lanes.values())
    parts = []
    for part in shapely.get_parts(wide):
        islands = []
        for ring in part.interiors:
            hole = Polygon(ring)
            around = hole.buffer(shoulder + _NARROWEST_NOTCH)
            near = [lanes[index] for index in tree.query(around, predicate="intersects")]
            if _is_island(hole, around, near):
                islands.append(ring)
        parts.append(Polygon(part.exterior, islands))
    return shapely.union_all(parts).simplify(_KERB_TOLERANCE)


def _is_island(hole: Polygon, around: Polygon, near: Collection[Lane]) -> bool:
    """Tell an island that traffic drives around from a leftover between the lanes of one junction."""
    if hole.area >= _SMALLEST_BLOCK:
        return True
    if hole.area < _SMALLEST_ISLAND:
        return False
    junctions = {lane.junction for lane in near if lane.junction is not None}
    streets = [
        shapely.intersection(outline(lane), around) for lane in near if lane.junction is None
    ]
    # Streets come up to a leftover with their ends; beside an island they run along.
    return len(junctions) != 1 or any(_extent(part) >= _RUNS_BESIDE for part in streets)


def _extent(part: shapely.Geometry) -> float:
    """Diagonal of the bounding box [m]."""
    low_x, low_y, high_x, high_y = part.bounds
    return float(np.hypot(high_x - low_x, high_y - low_y))


def outline(lane: Lane) -> Polygon:
    """Outline one lane.

    Args:
        lane: The lane.

    Returns:
        Its area, world frame [m]; empty if the lane has no length.
    """
    line = LineString(lane.centerline)
    if line.length < _SHORTEST_LANE:
        return Polygon()
    if lane.widths is None:
        return line.buffer(0.5 * lane.width, cap_style="flat", join_style="mitre")
    half = np.maximum(lane.widths, _THINNEST) / 2
    left, right = (offset_polyline(lane.centerline, side * half) for side in (1.0, -1.0))
    # Piece by piece: in a tight bend the inner edge runs back on itself.
    corners = np.stack([right[:-1], right[1:], left[1:], left[:-1]], axis=1)
    return shapely.union_all(shapely.convex_hull(shapely.polygons(corners)))
