"""Where the lanes of an OpenDRIVE road run."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from mjdrive.errors import TownFormatError
from mjdrive.town.reference_line import curvature_of, reference_line
from mjdrive.town.road_map import LaneRecord, Road
from mjdrive.town.road_shapes import Cubic, Line

__all__ = [
    "CHORD_ERROR",
    "LARGEST_GAP",
    "curvature_of",
    "evaluate",
    "lane_centre",
    "lane_edge",
    "lane_edges",
    "reference_line",
    "section_bounds",
]

LARGEST_GAP = 0.5
"""Largest distance between two points of a line along a lane [m]."""

CHORD_ERROR = 0.0005
"""Largest distance of the polyline of a lane from its true curve [m]."""

_SHORTEST_STEP = 0.001
"""Where a line jumps no step is short enough; this one ends the search [m]."""

_MOST_POINTS = 300_000
"""Largest number of points of one line: more than 100 km of road, or a map that oscillates."""

_NOTHING = Cubic(0.0, 0.0)

_QUARTERS = np.array([[0.25], [0.5], [0.75]])


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


def lane_centre(
    road: Road, section_index: int, lane_id: int
) -> tuple[Float[np.ndarray, "N 2"], Float[np.ndarray, " N"]]:
    """Sample the centre line of a lane in the direction of s.

    Args:
        road: Road of the lane.
        section_index: Index of its lane section.
        lane_id: Signed lane number, not 0.

    Returns:
        Points in the world frame, shape (N, 2) [m], and widths there, shape (N,) [m].

    Raises:
        TownFormatError: If the lane bends too sharply to be sampled.
    """
    line = _line_beside(road, section_index, lane_id, 0.5)
    return line[:, :2], line[:, 2]


def lane_edge(road: Road, section_index: int, lane_id: int) -> Float[np.ndarray, "N 2"]:
    """Sample the outer edge of a lane in the direction of s; for lane 0 the line between the sides.

    Args:
        road: Road of the lane.
        section_index: Index of its lane section.
        lane_id: Signed lane number.

    Returns:
        Points in the world frame, shape (N, 2) [m].

    Raises:
        TownFormatError: If the edge bends too sharply to be sampled.
    """
    return _line_beside(road, section_index, lane_id, 1.0)[:, :2]


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
    """
    section = road.sections[section_index]
    inner = outer = evaluate(road.lane_offsets, s)
    side = 1 if lane_id > 0 else -1
    for number in range(side, lane_id + side, side) if lane_id else ():
        lane = section.lane(number)
        assert lane is not None, f"road '{road.id}' has no lane {number} in section {section_index}"
        inner, outer = outer, _outer_edge(lane, side, outer, s - section.s)
    return inner, outer


def _outer_edge(
    lane: LaneRecord, side: int, inner: Float[np.ndarray, " N"], ds: Float[np.ndarray, " N"]
) -> Float[np.ndarray, " N"]:
    # Where a lane has both, widths count (OpenDRIVE 1.8, 11.6).
    if lane.widths or not lane.borders:
        return inner + side * np.maximum(evaluate(lane.widths, ds), 0.0)
    outer = evaluate(lane.borders, ds)
    return np.maximum(outer, inner) if side > 0 else np.minimum(outer, inner)


def _line_beside(
    road: Road, section_index: int, lane_id: int, share: float
) -> Float[np.ndarray, "N 3"]:
    """Sample a line along a lane, halving steps until they keep to `CHORD_ERROR` and `LARGEST_GAP`.

    Args:
        road: Road of the lane.
        section_index: Index of its lane section.
        lane_id: Signed lane number.
        share: Where in the lane, 0 at the inner edge and 1 at the outer one.

    Returns:
        x and y in the world frame, and width of the lane [m].
    """
    s = _first_stations(road, section_index, lane_id)
    line = _place(road, section_index, lane_id, share, s)
    untried = np.full(len(s) - 1, not _is_straight(road, section_index))
    while untried.any():
        left, right = s[:-1][untried], s[1:][untried]
        quarters = left + (right - left) * _QUARTERS  # (3, step)
        between = _place(road, section_index, lane_id, share, quarters.ravel()).reshape(3, -1, 3)
        is_split = (right - left > _SHORTEST_STEP) & _is_too_long(
            line[:-1, :2][untried], line[1:, :2][untried], between[:, :, :2]
        )
        if not is_split.any():
            break
        at = np.flatnonzero(untried)[is_split] + 1
        s = np.insert(s, at, quarters[1, is_split])
        line = np.insert(line, at, between[1, is_split], axis=0)
        if len(s) > _MOST_POINTS:
            raise TownFormatError(
                f"Lane {lane_id} of road '{road.id}' needs more than {_MOST_POINTS} points to be drawn. Check its "
                "width, its lane offset and the geometry of the road."
            )
        untried = np.zeros(len(s) - 1, dtype=bool)
        new = at + np.arange(len(at))
        untried[new - 1] = untried[new] = True
    return line


def _place(
    road: Road, section_index: int, lane_id: int, share: float, s: Float[np.ndarray, " N"]
) -> Float[np.ndarray, "N 3"]:
    """Evaluate a line along a lane: x, y and width of the lane [m]."""
    inner, outer = lane_edges(road, section_index, lane_id, s)
    points, heading = reference_line(road.pieces, s)
    offset = inner + share * (outer - inner)
    x = points[:, 0] - offset * np.sin(heading)
    y = points[:, 1] + offset * np.cos(heading)
    return np.stack([x, y, np.abs(outer - inner)], axis=1)


def _is_straight(road: Road, section_index: int) -> bool:
    """Tell whether all lines of a section are parallel to one straight line."""
    if len(road.pieces) > 1 or not isinstance(road.pieces[0].shape, Line):
        return False
    lanes = road.sections[section_index].lanes
    cubics = [road.lane_offsets, *(lane.widths or lane.borders for lane in lanes)]
    return all(len(some) <= 1 and not any(c.b or c.c or c.d for c in some) for some in cubics)


def _is_too_long(
    left: Float[np.ndarray, "N 2"],
    right: Float[np.ndarray, "N 2"],
    between: Float[np.ndarray, "3 N 2"],
) -> np.ndarray:
    """Tell which chords are too long, or too far from the curve at a quarter, a half or three quarters."""
    chord = right - left
    length = np.hypot(*chord.T)
    share = np.einsum("qni,ni->qn", between - left, chord) / np.maximum(length, 1e-12) ** 2
    foot = left + np.clip(share, 0.0, 1.0)[:, :, None] * chord
    away = np.hypot(*np.moveaxis(between - foot, -1, 0))
    # The largest deviation of an S-shaped step is 3 % more than at its quarters.
    limits = CHORD_ERROR * np.array([0.95, 1.0, 0.95])[:, None]
    return (length > LARGEST_GAP * (1.0 + 1e-6)) | (away > limits).any(axis=0)


def _first_stations(road: Road, section_index: int, lane_id: int) -> Float[np.ndarray, " N"]:
    """Choose stations of a section: where pieces and cubics start, and between them as dense as arcs ask for."""
    start, end = section_bounds(road, section_index)
    knots = [start, *(piece.s for piece in road.pieces if start < piece.s < end), end]
    stations = [np.array([start])]
    for left, right in pairwise(knots):
        if right - left < 1e-6:
            continue
        piece = max((p for p in road.pieces if p.s <= 0.5 * (left + right)), key=lambda p: p.s)
        gap = LARGEST_GAP
        if curvature := curvature_of(piece):
            gap = min(gap, max(np.sqrt(8.0 * CHORD_ERROR / abs(curvature)), _SHORTEST_STEP))
        stations.append(np.linspace(left, right, int(np.ceil((right - left) / gap)) + 1)[1:])
    s = np.concatenate(stations)
    breaks = np.array(
        [place for place in _breaks(road, section_index, lane_id) if start < place < end]
    )
    if not len(breaks):
        return s
    nearest = np.abs(s[:, None] - breaks).min(axis=0)
    return np.union1d(s, breaks[nearest > 1e-6])


def _breaks(road: Road, section_index: int, lane_id: int) -> list[float]:
    """Where the cubics start that place a lane."""
    section = road.sections[section_index]
    within = [
        section.s + cubic.start
        for lane in section.lanes
        if 0 < lane.id * np.sign(lane_id) <= abs(lane_id)
        for cubic in (*lane.widths, *lane.borders)
    ]
    return sorted({cubic.start for cubic in road.lane_offsets} | set(within))
