"""How the lanes of OpenDRIVE roads lie across them."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from mjdrive.errors import TownFormatError
from mjdrive.town.opendrive.piecewise import Piecewise
from mjdrive.town.opendrive.road_map import Road
from mjdrive.town.opendrive.road_shapes import Cubic

WIDEST_LANE = 100.0
"""Widest lane [m]."""

_NOTHING = Cubic(0.0, 0.0)


class LaneOfRoad(NamedTuple):
    """A lane of a map.

    Attributes:
        road: Road of the lane.
        section: Index of its lane section.
        lane: Signed lane number; 0 is the line between the sides.
    """

    road: Road
    section: int
    lane: int


class Cubics:
    """Several functions, each made of cubics that follow each other.

    Args:
        functions: Cubics of each in order of their starts; it is 0 everywhere if there are none.
    """

    def __init__(self, functions: Sequence[Sequence[Cubic]]) -> None:
        self._table = Piecewise(
            [[(c.start, c.a, c.b, c.c, c.d) for c in cubics or (_NOTHING,)] for cubics in functions]
        )

    def at(
        self, which: Int[np.ndarray, " N"], s: Float[np.ndarray, " N"]
    ) -> Float[np.ndarray, " N"]:
        """Evaluate them.

        Args:
            which: Number of the function of each place.
            s: Where, in the frame of the starts [m].

        Returns:
            Their values [m].
        """
        start, a, b, c, d = self._table.numbers(self._table.find(which, s))
        ds = s - start
        value: Float[np.ndarray, " N"] = a + ds * (b + ds * (c + ds * d))
        return value


class CrossSections:
    """Where several lanes lie across their roads.

    Args:
        lanes: The lanes.
    """

    def __init__(self, lanes: Sequence[LaneOfRoad]) -> None:
        self._lanes = lanes
        self._offsets = Cubics([lane.road.lane_offsets for lane in lanes])
        self._starts = np.array([lane.road.sections[lane.section].s for lane in lanes])
        self._sides = np.array([1.0 if lane.lane > 0 else -1.0 for lane in lanes])
        self._depths = np.array([abs(lane.lane) for lane in lanes], dtype=int)
        self._steps = [_Step(lanes, step) for step in range(1, self._depths.max(initial=0) + 1)]

    def edges(
        self, which: Int[np.ndarray, " N"], s: Float[np.ndarray, " N"]
    ) -> tuple[Float[np.ndarray, " N"], Float[np.ndarray, " N"]]:
        """Tell where the edges of the lanes lie; a negative width counts as 0.

        Args:
            which: Number of the lane of each place.
            s: Where along its road, within the section of the lane [m].

        Returns:
            t of the edge towards lane 0 and t of the other edge, positive to the left; both are the same for lane 0 [m].

        Raises:
            TownFormatError: If a lane or one between it and lane 0 is wider than `WIDEST_LANE`.
        """
        outer = self._offsets.at(which, s)
        inner = outer.copy()
        for depth, step in enumerate(self._steps, start=1):
            here = np.flatnonzero(self._depths[which] >= depth)
            lane, before = which[here], outer[here]
            after = step.outer_edge(
                lane, self._sides[lane], before, (s - self._starts[which])[here]
            )
            self._require_width(depth, lane, np.abs(after - before))
            inner[here], outer[here] = before, after
        return inner, outer

    def _require_width(
        self, depth: int, lane: Int[np.ndarray, " N"], width: Float[np.ndarray, " N"]
    ) -> None:
        if width.max(initial=0.0) > WIDEST_LANE:
            first = lane[np.argmax(width > WIDEST_LANE)]
            raise TownFormatError(
                f"Lane {self._sides[first] * depth:.0f} of road '{self._lanes[first].road.id}' is up to "
                f"{width[lane == first].max():g} m wide; expected at most {WIDEST_LANE:g} m."
            )


class _Step:
    """The lanes at one distance from lane 0, counted in lanes, that lie between it and some lanes."""

    def __init__(self, lanes: Sequence[LaneOfRoad], depth: int) -> None:
        functions: list[Sequence[Cubic]] = []
        is_border = []
        for road, section, number in lanes:
            beside = depth if number > 0 else -depth
            record = road.sections[section].lane(beside) if abs(number) >= depth else None
            assert record or abs(number) < depth, (
                f"road '{road.id}' has no lane {beside} in section {section}"
            )
            # Where a lane has both, widths count (OpenDRIVE 1.8, 11.6).
            functions.append(record.widths or record.borders if record else ())
            is_border.append(bool(record and record.borders and not record.widths))
        self._cubics, self._is_border = Cubics(functions), np.array(is_border)

    def outer_edge(
        self,
        which: Int[np.ndarray, " N"],
        side: Float[np.ndarray, " N"],
        inner: Float[np.ndarray, " N"],
        ds: Float[np.ndarray, " N"],
    ) -> Float[np.ndarray, " N"]:
        """Tell where these lanes end, from where they begin [m]."""
        value = self._cubics.at(which, ds)
        by_width = inner + side * np.maximum(value, 0.0)
        if not self._is_border.any():
            return by_width
        by_border = np.where(side > 0, np.maximum(value, inner), np.minimum(value, inner))
        return np.where(self._is_border[which], by_border, by_width)


def section_bounds(road: Road, section_index: int) -> tuple[float, float]:
    """Tell where a lane section starts and ends along its road [m]."""
    following = road.sections[section_index + 1 : section_index + 2]
    return road.sections[section_index].s, following[0].s if following else road.length
