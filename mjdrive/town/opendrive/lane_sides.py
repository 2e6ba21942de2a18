"""Lane sections that hold one side of a road only: the lanes of the other side go on."""

from collections.abc import Sequence
from dataclasses import replace

from mjdrive.town.opendrive.road_map import LaneRecord, LaneSection
from mjdrive.town.opendrive.road_shapes import Cubic, RoadMark

_SAME_PLACE = 1e-9
"""Sections that start closer together than this are one [m]."""


def carry_over(sections: list[LaneSection], following: LaneSection) -> None:
    """Append a section that holds the lanes of one side, with those of the other side as they were.

    Args:
        sections: The sections before it, both sides in each; changed in place.
        following: The section, with lanes of one side and lane 0.
    """
    before = sections[-1]
    ds = following.s - before.s
    renewed = {_side(lane) for lane in following.lanes}
    kept = [lane for lane in before.lanes if _side(lane) not in renewed]
    if ds <= _SAME_PLACE:
        sections[-1] = _section(following.s, [*following.lanes, *kept])
        return
    ended = [
        lane if _side(lane) in renewed else replace(lane, successor=lane.id)
        for lane in before.lanes
    ]
    sections[-1] = _section(before.s, ended)
    carried = [_moved(lane, ds) for lane in kept]
    sections.append(_section(following.s, [*following.lanes, *carried]))


def _side(lane: LaneRecord) -> int:
    return (lane.id > 0) - (lane.id < 0)


def _section(s: float, lanes: Sequence[LaneRecord]) -> LaneSection:
    return LaneSection(s, tuple(sorted(lanes, key=lambda lane: -lane.id)))


def _moved(lane: LaneRecord, ds: float) -> LaneRecord:
    """The rest of a lane behind a place `ds` [m] from its start, as a lane of its own."""
    return replace(
        lane,
        widths=_moved_cubics(lane.widths, ds),
        borders=_moved_cubics(lane.borders, ds),
        marks=_moved_marks(lane.marks, ds),
        predecessor=lane.id,
    )


def _moved_cubics(cubics: Sequence[Cubic], ds: float) -> tuple[Cubic, ...]:
    rest = [replace(cubic, start=cubic.start - ds) for cubic in cubics if cubic.start > ds]
    current = [cubic for cubic in cubics if cubic.start <= ds][-1:]
    return (*(_rebased(cubic, ds - cubic.start) for cubic in current), *rest)


def _rebased(cubic: Cubic, x: float) -> Cubic:
    """The same cubic with its origin `x` [m] further on."""
    a, b, c, d = cubic.a, cubic.b, cubic.c, cubic.d
    return Cubic(
        0.0, a + x * (b + x * (c + x * d)), b + x * (2.0 * c + 3.0 * d * x), c + 3.0 * d * x, d
    )


def _moved_marks(marks: Sequence[RoadMark], ds: float) -> tuple[RoadMark, ...]:
    rest = [replace(mark, start=mark.start - ds) for mark in marks if mark.start > ds]
    current = [replace(mark, start=0.0) for mark in marks if mark.start <= ds][-1:]
    return (*current, *rest)
