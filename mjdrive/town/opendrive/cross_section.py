"""How the lanes of an OpenDRIVE road lie across it."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from mjdrive.errors import TownFormatError
from mjdrive.town.opendrive.road_map import LaneRecord, Road
from mjdrive.town.opendrive.road_shapes import Cubic

WIDEST_LANE = 100.0
"""Widest lane [m]."""

_NOTHING = Cubic(0.0, 0.0)


def evaluate(cubics: Sequence[Cubic], s: Float[np.ndarray, " N"]) -> Float[np.ndarray, " N"]:
    """Evaluate cubics that follow each other.

    Args:
        cubics: In order of their starts; 0 everywhere if there are none.
        s: Where, in the frame of the starts [m].

    Returns:
        Their values [m].
    """
    if len(cubics) < 2:
        cubic = cubics[0] if cubics else _NOTHING
        ds, a, b, c, d = s - cubic.start, cubic.a, cubic.b, cubic.c, cubic.d
    else:
        table = np.array([(cubic.start, cubic.a, cubic.b, cubic.c, cubic.d) for cubic in cubics])
        index = np.searchsorted(table[:, 0], s + 1e-9, side="right") - 1
        starts, a, b, c, d = table[np.maximum(index, 0)].T
        ds = s - starts
    value: Float[np.ndarray, " N"] = a + ds * (b + ds * (c + ds * d))
    return value


def section_bounds(road: Road, section_index: int) -> tuple[float, float]:
    """Tell where a lane section starts and ends along its road [m]."""
    following = road.sections[section_index + 1 : section_index + 2]
    return road.sections[section_index].s, following[0].s if following else road.length


def lane_edges(
    road: Road, section_index: int, lane_id: int, s: Float[np.ndarray, " N"]
) -> tuple[Float[np.ndarray, " N"], Float[np.ndarray, " N"]]:
    """Tell where the edges of a lane lie across its road; a negative width counts as 0.

    Args:
        road: Road of the lane.
        section_index: Index of its lane section.
        lane_id: Signed lane number; both edges of lane 0 are the same.
        s: Where along the road, within the section [m].

    Returns:
        t of the edge towards lane 0 and t of the other edge, positive to the left [m].

    Raises:
        TownFormatError: If the lane or one between it and lane 0 is wider than `WIDEST_LANE`.
    """
    section = road.sections[section_index]
    inner = outer = evaluate(road.lane_offsets, s)
    side = 1 if lane_id > 0 else -1
    for number in range(side, lane_id + side, side) if lane_id else ():
        lane = section.lane(number)
        assert lane is not None, f"road '{road.id}' has no lane {number} in section {section_index}"
        inner, outer = outer, _outer_edge(lane, side, outer, s - section.s)
        widest = np.abs(outer - inner).max(initial=0.0)
        if widest > WIDEST_LANE:
            raise TownFormatError(
                f"Lane {number} of road '{road.id}' is up to {widest:g} m wide; expected at most {WIDEST_LANE:g} m."
            )
    return inner, outer


def _outer_edge(
    lane: LaneRecord, side: int, inner: Float[np.ndarray, " N"], ds: Float[np.ndarray, " N"]
) -> Float[np.ndarray, " N"]:
    # Where a lane has both, widths count (OpenDRIVE 1.8, 11.6).
    if lane.widths or not lane.borders:
        return inner + side * np.maximum(evaluate(lane.widths, ds), 0.0)
    outer = evaluate(lane.borders, ds)
    return np.maximum(outer, inner) if side > 0 else np.minimum(outer, inner)
