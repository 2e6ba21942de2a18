"""Where the lanes of an OpenDRIVE road run."""

from itertools import pairwise

import numpy as np
from jaxtyping import Float

from mjdrive.errors import TownFormatError
from mjdrive.town.opendrive.cross_section import lane_edges, section_bounds
from mjdrive.town.opendrive.reference_line import curvature_of, reference_line
from mjdrive.town.opendrive.road_map import Road
from mjdrive.town.opendrive.road_shapes import Line

LARGEST_GAP = 0.5
"""Largest distance between two points of a line along a lane [m]."""

CHORD_ERROR = 0.0005
"""Largest distance of the polyline of a lane from its true curve [m]."""

_SHORTEST_STEP = 0.001
"""Where a line jumps no step is short enough; this one ends the search [m]."""

_MOST_POINTS = 300_000
"""Largest number of points of one line: more than 100 km of road, or a map that oscillates."""

_QUARTERS = np.array([[0.25], [0.5], [0.75]])


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
