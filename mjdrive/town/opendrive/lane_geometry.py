"""Where the lanes of OpenDRIVE roads run."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from jaxtyping import Float, Int

from mjdrive.errors import TownFormatError
from mjdrive.town.opendrive.cross_section import CrossSections, LaneOfRoad, section_bounds
from mjdrive.town.opendrive.reference_line import ReferenceLines, curvature_of
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

_AT_ONCE = 20_000
"""Points to begin with that are worked on at once: enough for numpy, few enough for the cache."""

_QUARTERS = np.array([[0.25], [0.5], [0.75]])


def lane_centres(
    lanes: Sequence[LaneOfRoad],
) -> Iterator[tuple[Float[np.ndarray, "_ 2"], Float[np.ndarray, " _"]]]:
    """Sample the centre lines of lanes in the direction of s.

    Args:
        lanes: The lanes, none of them lane 0.

    Yields:
        Points in the world frame, shape (N, 2) [m], and widths there, shape (N,) [m], of each lane.

    Raises:
        TownFormatError: If a lane bends too sharply to be sampled.
    """
    for line in _lines_along(lanes, 0.5):
        yield line[:, :2], line[:, 2]


def lane_outer_edges(lanes: Sequence[LaneOfRoad]) -> Iterator[Float[np.ndarray, "_ 2"]]:
    """Sample the outer edges of lanes in the direction of s; for lane 0 the line between the sides.

    Args:
        lanes: The lanes.

    Yields:
        Points of each in the world frame, shape (N, 2) [m].

    Raises:
        TownFormatError: If an edge bends too sharply to be sampled.
    """
    for line in _lines_along(lanes, 1.0):
        yield line[:, :2]


def _lines_along(lanes: Sequence[LaneOfRoad], share: float) -> Iterator[Float[np.ndarray, "_ 3"]]:
    """Sample a line along each lane: x and y in the world frame, and width of the lane [m].

    Args:
        lanes: The lanes.
        share: Where in a lane, 0 at the inner edge and 1 at the outer one.
    """
    waiting: list[LaneOfRoad] = []
    stations: list[Float[np.ndarray, " _"]] = []
    num_points = 0
    along: dict[tuple[str, int], Float[np.ndarray, " _"]] = {}  # the lanes of a section share it
    for lane in lanes:
        road, section, number = lane
        if (road.id, section) not in along:
            along[road.id, section] = _along_section(road, section)
        waiting.append(lane)
        stations.append(_with_breaks(along[road.id, section], _breaks(road, section, number)))
        num_points += len(stations[-1])
        if num_points >= _AT_ONCE:
            yield from _Lines(waiting, share).sample(stations)
            waiting, stations, num_points = [], [], 0
    if waiting:
        yield from _Lines(waiting, share).sample(stations)


class _Lines:
    """Lines along some lanes.

    Args:
        lanes: The lanes.
        share: Where in a lane, 0 at the inner edge and 1 at the outer one.
    """

    def __init__(self, lanes: Sequence[LaneOfRoad], share: float) -> None:
        self._lanes, self._share = lanes, share
        self._cross_sections = CrossSections(lanes)
        self._reference_lines = ReferenceLines([lane.road.pieces for lane in lanes])

    def sample(
        self, stations: Sequence[Float[np.ndarray, " _"]]
    ) -> Iterator[Float[np.ndarray, "_ 3"]]:
        """Sample the lines, halving steps until they keep to `CHORD_ERROR` and `LARGEST_GAP`."""
        which = np.repeat(np.arange(len(stations)), [len(s) for s in stations])
        s = np.concatenate(stations)
        line = self._place(which, s)
        is_bent = np.array([not _is_straight(lane.road, lane.section) for lane in self._lanes])
        untried = (which[1:] == which[:-1]) & is_bent[which[1:]]
        while untried.any():
            left, right = s[:-1][untried], s[1:][untried]
            quarters = left + (right - left) * _QUARTERS  # (3, step)
            between = self._place(np.tile(which[1:][untried], 3), quarters.ravel())
            between = between.reshape(3, -1, 3)
            is_split = (right - left > _SHORTEST_STEP) & _is_too_long(
                line[:-1, :2][untried], line[1:, :2][untried], between[:, :, :2]
            )
            if not is_split.any():
                break
            at = np.flatnonzero(untried)[is_split] + 1
            s = np.insert(s, at, quarters[1, is_split])
            line = np.insert(line, at, between[1, is_split], axis=0)
            which = np.insert(which, at, which[at])
            self._require_few(which)
            untried = np.zeros(len(s) - 1, dtype=bool)
            new = at + np.arange(len(at))
            untried[new - 1] = untried[new] = True
        yield from np.split(line, np.flatnonzero(np.diff(which)) + 1)

    def _place(
        self, which: Int[np.ndarray, " N"], s: Float[np.ndarray, " N"]
    ) -> Float[np.ndarray, "N 3"]:
        """Evaluate the lines: x, y and width of the lane [m]."""
        inner, outer = self._cross_sections.edges(which, s)
        points, heading = self._reference_lines.at(which, s)
        offset = inner + self._share * (outer - inner)
        x = points[:, 0] - offset * np.sin(heading)
        y = points[:, 1] + offset * np.cos(heading)
        return np.stack([x, y, np.abs(outer - inner)], axis=1)

    def _require_few(self, which: Int[np.ndarray, " N"]) -> None:
        points = np.bincount(which)
        if points.max() > _MOST_POINTS:
            lane = self._lanes[int(points.argmax())]
            raise TownFormatError(
                f"Lane {lane.lane} of road '{lane.road.id}' needs more than {_MOST_POINTS} points to be drawn. Check "
                "its width, its lane offset and the geometry of the road."
            )


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


def _along_section(road: Road, section_index: int) -> Float[np.ndarray, " N"]:
    """Choose stations of a section: where pieces start, and between them as dense as arcs ask for."""
    start, end = section_bounds(road, section_index)
    knots = [start, *(piece.s for piece in road.pieces if start < piece.s < end), end]
    stations = [np.array([start])]
    for left, right in pairwise(knots):
        if right - left < 1e-6:
            continue
        piece = max((p for p in road.pieces if p.s <= 0.5 * (left + right)), key=lambda p: p.s)
        gap = LARGEST_GAP
        if curvature := curvature_of(piece):
            gap = min(gap, max(math.sqrt(8.0 * CHORD_ERROR / abs(curvature)), _SHORTEST_STEP))
        stations.append(np.linspace(left, right, math.ceil((right - left) / gap) + 1)[1:])
    return np.concatenate(stations)


def _with_breaks(s: Float[np.ndarray, " N"], breaks: Sequence[float]) -> Float[np.ndarray, " M"]:
    """Add places to stations, unless there is a station already."""
    inside = np.array([place for place in breaks if s[0] < place < s[-1]])
    if not len(inside):
        return s
    nearest = np.abs(s[:, None] - inside).min(axis=0)
    return np.sort(np.concatenate([s, inside[nearest > 1e-6]]))


def _breaks(road: Road, section_index: int, lane_id: int) -> list[float]:
    """Where the cubics start that place a lane."""
    section = road.sections[section_index]
    side = (lane_id > 0) - (lane_id < 0)
    within = {
        section.s + cubic.start
        for lane in section.lanes
        if 0 < lane.id * side <= abs(lane_id)
        for cubic in (*lane.widths, *lane.borders)
    }
    return sorted({cubic.start for cubic in road.lane_offsets} | within)
