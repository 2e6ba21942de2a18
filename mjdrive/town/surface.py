"""The ground that lanes and roads cover, as polygons."""

import shapely
from shapely.geometry import LineString, MultiPolygon, Polygon

from mjdrive.datatypes import Town

_SEAM = 0.01
"""Cracks between lanes that count as rounding, not as gaps [m]."""

_SMALLEST_BLOCK = 300.0
"""Islands below this area are leftovers between turning lanes, not places to build on [m^2]."""

_NARROWEST_NOTCH = 1.0
"""Kerbs do not follow notches narrower than this [m]."""

_KERB_TOLERANCE = 0.01
"""How far a straight kerb may lie from a curved edge: fewer, longer kerbs [m]."""


def lane_polygons(town: Town) -> dict[str, Polygon]:
    """Outline each lane.

    Args:
        town: The town.

    Returns:
        The area of each lane by its name, world frame [m].
    """
    return {
        name: LineString(lane.centerline).buffer(
            0.5 * lane.width, cap_style="flat", join_style="mitre"
        )
        for name, lane in town.lanes.items()
    }


def driving_surface(town: Town) -> Polygon | MultiPolygon:
    """Join all lanes: where a car is on the road.

    Args:
        town: The town.

    Returns:
        Union of the lanes, world frame [m].
    """
    union = shapely.union_all(list(lane_polygons(town).values()))
    return union.buffer(_SEAM, join_style="mitre").buffer(-_SEAM, join_style="mitre")


def road_surface(town: Town, shoulder: float = 0.3) -> Polygon | MultiPolygon:
    """Widen the lanes by the gutter: its boundary is where the kerbs stand.

    Junctions are one clean area: the leftovers between turning lanes belong to it.

    Args:
        town: The town.
        shoulder: Width of the gutter between lane and kerb [m].

    Returns:
        The road with city blocks as holes, world frame [m].
    """
    wide = (
        driving_surface(town).buffer(shoulder + _NARROWEST_NOTCH / 2).buffer(-_NARROWEST_NOTCH / 2)
    )
    parts = [_fill_small_holes(part) for part in shapely.get_parts(wide)]
    return shapely.union_all(parts).simplify(_KERB_TOLERANCE)


def _fill_small_holes(polygon: Polygon) -> Polygon:
    blocks = [ring for ring in polygon.interiors if Polygon(ring).area >= _SMALLEST_BLOCK]
    return Polygon(polygon.exterior, blocks)
