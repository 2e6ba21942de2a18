"""Which lanes lie under and around a point, found without walking through the whole town."""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import shapely

from mjdrive.datatypes import Lane, Town

REACH = 10.0
"""Lanes whose centre lines are farther from a point than this may be left out [m]."""

_CELL = 8.0
"""Side of the squares that remember which segments are near them [m]."""

_SEAM = 0.01
"""Cracks between lanes that count as rounding, not as gaps [m]."""

_SHORTEST_SEGMENT = 1e-9
"""Shorter segments, as a lane at the centre of its bend has them, count as points [m]."""

_FRAME, _LENGTH, _HALF_WIDTHS, _STATION = slice(0, 6), 6, slice(7, 9), 9
"""Columns of the table of `_segments`."""


class LanePlace(NamedTuple):
    """A point seen from one lane: its Frenet coordinates, and what the lane is like there.

    Attributes:
        lane: Name of the lane.
        station: Arc length of the nearest point of the centre line [m].
        offset: Signed distance from the centre line, positive to the left of travel [m].
        yaw: Direction of travel there [rad].
        half_width: Half of the width there [m].
        is_inside: Whether the point lies on the lane: within its edges, not beyond its ends.
    """

    lane: str
    station: float
    offset: float
    yaw: float
    half_width: float
    is_inside: bool


class Segment(NamedTuple):
    """One straight piece of a centre line.

    Attributes:
        row: Number of the segment in the town [-].
        cos: Of its direction [-].
        sin: Of its direction [-].
        along_offset: Along it, `cos x + sin y + along_offset` past its start [m].
        left_offset: To its left, `cos y - sin x + left_offset` from it [m].
        length: Of it [m].
        half_width: Half of the least width of the lane beside it [m].
        yaw: Its direction [rad].
    """

    row: int
    cos: float
    sin: float
    along_offset: float
    left_offset: float
    length: float
    half_width: float
    yaw: float


class LaneIndex:
    """The centre lines of a town, cut into segments and sorted by place.

    Args:
        town: The town.
    """

    def __init__(self, town: Town) -> None:
        lanes = list(town.lanes.values())
        self._names = [lane.id for lane in lanes]
        self._lane = np.repeat(np.arange(len(lanes)), [len(lane.centerline) - 1 for lane in lanes])
        self._table = np.concatenate([_segments(lane) for lane in lanes])
        ends = np.cumsum([0, *(len(lane.centerline) - 1 for lane in lanes)]).tolist()
        self._rows = {
            name: slice(*rows) for name, rows in zip(self._names, pairwise(ends), strict=True)
        }
        lines = [np.stack([lane.centerline[:-1], lane.centerline[1:]], axis=1) for lane in lanes]
        self._tree = shapely.STRtree(shapely.linestrings(np.concatenate(lines)))
        self._widest = float(self._table[:, _HALF_WIDTHS].max()) + _SEAM
        self._cells: dict[tuple[float, int, int], _Cell] = {}

    def near(self, x: float, y: float) -> list[LanePlace]:
        """Find the lanes around a point.

        Args:
            x: World frame [m].
            y: World frame [m].

        Returns:
            One place on every lane whose centre line is within `REACH`, and on some farther ones.
        """
        return self._places(x, y, REACH, np.inf)

    def under(self, x: float, y: float) -> list[LanePlace]:
        """Find the lanes that a point lies on.

        Args:
            x: World frame [m].
            y: World frame [m].

        Returns:
            One place on each lane; none off the lanes, several where lanes overlap.
        """
        places = self._places(x, y, self._widest, self._widest)
        return [place for place in places if place.is_inside]

    def segment_at(self, place: LanePlace) -> Segment:
        """Find the segment that a place lies beside."""
        rows = self._rows[place.lane]
        starts = self._table[rows, _STATION]
        behind = int(np.searchsorted(starts, place.station, side="right"))
        return self._segment(rows.start + max(behind - 1, 0))

    def segment_after(self, segment: Segment) -> Segment | None:
        """Find the segment that follows on the same lane; None at its end."""
        row = segment.row + 1
        if row >= len(self._lane) or self._lane[row] != self._lane[segment.row]:
            return None
        return self._segment(row)

    def _segment(self, row: int) -> Segment:
        cos, sin, along, _, _, left, length, start, end, _, yaw, *_ = self._table[row].tolist()
        return Segment(row, cos, sin, along, left, length, min(start, end), yaw)

    def _places(self, x: float, y: float, reach: float, limit: float) -> list[LanePlace]:
        """Nearest place on each lane around a point, as far as `limit` [m]; `reach` says how far to look [m]."""
        key = (reach, math.floor(x / _CELL), math.floor(y / _CELL))
        cell = self._cells.get(key)
        if cell is None:
            cell = self._cells[key] = self._cut(*key)
        along, left = cell.frames @ (x, y, 1.0)
        beyond = along - np.minimum(np.maximum(along, 0.0), cell.lengths)
        distance = np.hypot(beyond, left)
        best = [first + int(distance[first:last].argmin()) for first, last in cell.spans]
        return [
            self._place(cell, index, along=float(along[index]), left=float(left[index]), off=off)
            for index in best
            if (off := float(distance[index])) <= limit
        ]

    def _cut(self, reach: float, column: int, row: int) -> "_Cell":
        """Collect the segments around one square, those of a lane side by side."""
        x, y = column * _CELL, row * _CELL
        box = shapely.box(x - reach, y - reach, x + _CELL + reach, y + _CELL + reach)
        found = np.sort(self._tree.query(box))
        lanes, table = self._lane[found], self._table[found]
        first = [0, *(np.flatnonzero(lanes[1:] != lanes[:-1]) + 1).tolist(), len(found)]
        return _Cell(
            frames=table[:, _FRAME].reshape(-1, 2, 3).transpose(1, 0, 2).copy(),
            lengths=table[:, _LENGTH].copy(),
            lanes=lanes,
            spans=list(pairwise(first)) if len(found) else [],
            facts=table[:, _LENGTH:],
        )

    def _place(
        self, cell: "_Cell", index: int, *, along: float, left: float, off: float
    ) -> LanePlace:
        """Describe a point as seen from one segment: `along` it, to the `left` and `off` it [m]."""
        length, half_start, half_end, station, yaw, margin_before, margin_after = cell.facts[
            index
        ].tolist()
        clipped = min(max(along, 0.0), length)
        half_width = half_start + clipped / length * (half_end - half_start)
        is_between_ends = -margin_before <= along <= length + margin_after
        return LanePlace(
            self._names[cell.lanes[index]],
            station + clipped,
            math.copysign(off, left),
            yaw,
            half_width,
            is_between_ends and off <= half_width + _SEAM,
        )


class _Cell(NamedTuple):
    """The segments around one square of the town.

    Attributes:
        frames: World point with a 1 to distance along and to the left of each segment, shape (2, S, 3).
        lengths: Of the segments, shape (S,) [m].
        lanes: Number of the lane of each segment, shape (S,).
        spans: First segment of each lane, and the one after its last.
        facts: The rest of the table of `_segments`, shape (S, 7).
    """

    frames: np.ndarray
    lengths: np.ndarray
    lanes: np.ndarray
    spans: list[tuple[int, int]]
    facts: np.ndarray


def _segments(lane: Lane) -> np.ndarray:
    """Table of the segments of one lane, shape (S, 13).

    Columns: two rows of three that bring a world point into the frame of the segment, its length, half the width at
    both ends, station of its start, yaw, and how far beyond both ends the lane goes on.
    """
    start, along = lane.centerline[:-1], np.diff(lane.centerline, axis=0)
    length = np.maximum(np.hypot(*along.T), _SHORTEST_SEGMENT)
    cos, sin = along.T / length
    cos[length == _SHORTEST_SEGMENT] = 1.0  # of a point any direction will do, and some are needed
    x, y = start.T
    half = 0.5 * (np.full(len(start) + 1, lane.width) if lane.widths is None else lane.widths)
    # Between two segments lies a wedge that belongs to the lane; beyond the first and the last one it ends.
    margins = np.full((2, len(start)), np.inf)
    margins[0, 0] = margins[1, -1] = _SEAM
    return np.stack(
        [
            *(cos, sin, -(cos * x + sin * y)),
            *(-sin, cos, sin * x - cos * y),
            *(length, half[:-1], half[1:], np.cumsum(length) - length, np.arctan2(sin, cos)),
            *margins,
        ],
        axis=1,
    )
