"""From an OpenDRIVE map to what is painted on the road and stands beside it."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import shapely
from jaxtyping import Float

from mjdrive.datatypes import Marking, Sign, StaticObject
from mjdrive.geometry import offset_polyline, project, stations, wrap_angle
from mjdrive.town.links import SHORTEST_SECTION
from mjdrive.town.opendrive.cross_section import CrossSections, LaneOfRoad, section_bounds
from mjdrive.town.opendrive.lane_geometry import lane_outer_edges
from mjdrive.town.opendrive.reference_line import places_beside, reference_line
from mjdrive.town.opendrive.road_map import LaneRecord, Road, RoadMap
from mjdrive.town.opendrive.road_shapes import RoadMark
from mjdrive.town.opendrive.vocabulary import LIGHT_TYPES, PAINTED_LINES, SIDEWALK_LANE_TYPES

DEFAULT_PAINT_WIDTH = 0.12
"""Width of a line where the map does not say [m]."""

DEFAULT_DASH = 3.0
"""Length of a dash and of the gap behind it where the map does not say [m]."""


def markings(road_map: RoadMap) -> tuple[Marking, ...]:
    """Paint the road marks of a map; a double line is two markings, a width of paint apart."""
    painted = [
        (LaneOfRoad(road, index, record.id), record)
        for road, index in _sections(road_map)
        for record in road.sections[index].lanes
        if any(mark.type in PAINTED_LINES for mark in record.marks)
    ]
    edges = lane_outer_edges([lane for lane, _ in painted])
    return tuple(
        marking
        for (lane, record), edge in zip(painted, edges, strict=True)
        for marking in _lane_markings(lane, record, edge)
    )


def signs(road_map: RoadMap) -> tuple[Sign, ...]:
    """Find the traffic signs of a map: its signals that never change."""
    standing = [
        (road, signal)
        for road in road_map.roads.values()
        for signal in road.signals
        if not signal.dynamic and signal.type not in LIGHT_TYPES
    ]
    points, headings = places_beside([(road, signal.s, signal.t) for road, signal in standing])
    found = []
    for (_, signal), (x, y), heading in zip(
        standing, points.tolist(), headings.tolist(), strict=True
    ):
        yaw = wrap_angle(heading + (np.pi if signal.orientation == "-" else 0.0))
        found.append(Sign(signal.id, signal.type, signal.value, signal.unit, x, y, yaw))
    return tuple(found)


def objects(road_map: RoadMap) -> tuple[StaticObject, ...]:
    """Find the things of a map that cover ground."""
    return tuple(
        StaticObject(record.id, record.type, np.array(record.outline), record.height)
        for road in road_map.roads.values()
        for record in road.objects
        if len(record.outline) >= 3
    )


def sidewalks(road_map: RoadMap) -> tuple[Float[np.ndarray, "_ 2"], ...]:
    """Outline the sidewalks of a map, counter-clockwise [m]."""
    sides = [
        LaneOfRoad(road, index, number)
        for road, index in _sections(road_map)
        for record in road.sections[index].lanes
        if record.type in SIDEWALK_LANE_TYPES and record.id != 0
        for number in sorted((record.id, record.id - (1 if record.id > 0 else -1)))
    ]
    edges = list(lane_outer_edges(sides))
    outlines = [
        np.concatenate([right, left[::-1]])
        for right, left in zip(edges[::2], edges[1::2], strict=True)
    ]
    return tuple(outline for outline in outlines if shapely.Polygon(outline).area > 0.0)


def _sections(road_map: RoadMap) -> Iterator[tuple[Road, int]]:
    for road in road_map.roads.values():
        for index in range(len(road.sections)):
            start, end = section_bounds(road, index)
            if end - start >= SHORTEST_SECTION:
                yield road, index


def _lane_markings(
    lane: LaneOfRoad, record: LaneRecord, edge: Float[np.ndarray, "_ 2"]
) -> Iterator[Marking]:
    """Paint the outer edge of a lane, or the middle of the road for lane 0."""
    # Inside out: to the right on the right side and along the middle, to the left on the left side.
    outward = 1.0 if record.id > 0 else -1.0
    if len(record.marks) == 1 and record.marks[0].start <= 0.0:
        yield from _lines(edge, record.marks[0], outward=outward)
        return
    along = stations(edge)
    cuts = _cuts(lane, record, edge)
    for mark, (first, last) in zip(record.marks, pairwise(cuts), strict=True):
        if mark.type in PAINTED_LINES and last - first >= SHORTEST_SECTION:
            inside = along[(along > first + 1e-6) & (along < last - 1e-6)]
            wanted = np.concatenate([[first], inside, [last]])
            line = np.stack([np.interp(wanted, along, edge[:, axis]) for axis in (0, 1)], axis=1)
            yield from _lines(line, mark, outward=outward)


def _cuts(lane: LaneOfRoad, record: LaneRecord, edge: Float[np.ndarray, "_ 2"]) -> list[float]:
    """Where along the edge of a lane its marks begin, and where the last one ends [m]."""
    start, end = section_bounds(lane.road, lane.section)
    starts = np.array([*(mark.start for mark in record.marks), end - start])
    s = start + np.clip(starts, 0.0, end - start)
    reference, heading = reference_line(lane.road.pieces, s)
    offset = CrossSections([lane]).edges(np.zeros(len(s), dtype=int), s)[1]
    places = reference + offset[:, None] * np.stack([-np.sin(heading), np.cos(heading)], axis=1)
    return [project(edge, place).station for place in places]


def _lines(line: Float[np.ndarray, "N 2"], mark: RoadMark, *, outward: float) -> Iterator[Marking]:
    """Lay the lines of a mark side by side around its middle."""
    kinds = PAINTED_LINES[mark.type]
    width = mark.width or DEFAULT_PAINT_WIDTH
    for number, kind in enumerate(kinds):
        shift = 2.0 * width * (number - 0.5 * (len(kinds) - 1)) * outward
        is_broken = kind == "broken"
        yield Marking(
            points=offset_polyline(line, shift) if shift else line,
            width=width,
            color="white" if mark.color == "standard" else mark.color,
            dash=(mark.dash or DEFAULT_DASH) if is_broken else 0.0,
            gap=(mark.gap or DEFAULT_DASH) if is_broken else 0.0,
        )
