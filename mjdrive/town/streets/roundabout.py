"""Roundabouts of a street plan: a one-way ring, and a junction wherever a street meets it."""

from itertools import pairwise

import numpy as np

from mjdrive.errors import TownFormatError
from mjdrive.town.opendrive.road_map import Junction, LaneRecord, LaneSection, Road, RoadLink
from mjdrive.town.opendrive.road_shapes import Cubic, Piece, RoadMark
from mjdrive.town.streets.fillet import Pose, join, length_of, turn_left
from mjdrive.town.streets.junction_builder import Crossing, connecting_road, junction_of
from mjdrive.town.streets.street_ends import contact, inward, outward, ring_junctions
from mjdrive.town.streets.street_plan import RoundaboutPlan, StreetPlan

_FIRST_RING_ROAD = 6000
"""Number of the first road of a ring."""

_SHORTEST_RING_ROAD = 1.0
"""Least length of the ring between two streets [m]."""

_KERB_MARK = RoadMark("curb", "standard", 0.152)


def build_roundabout(plan: StreetPlan, node: str, *, first_id: int) -> Crossing:
    """Draw a ring, driven counter-clockwise, and where streets meet it a way in, a way out and a way past.

    Args:
        plan: The street plan.
        node: Node of the roundabout.
        first_id: Number of the first connecting road.

    Returns:
        Connecting roads, a junction for each street, and the roads of the ring.

    Raises:
        TownFormatError: If streets meet the ring too close to each other, or are not listed counter-clockwise.
    """
    ring = plan.roundabouts[node]
    numbers = ring_junctions(plan)
    names = [str(_FIRST_RING_ROAD + int(numbers[node, road]) % 1000) for road in ring.arms]
    roads = _ring_roads(plan, node, names)
    ways: list[Road] = []
    junctions: list[Junction] = []
    for index, road in enumerate(ring.arms):
        # The ring road with the index of a street begins behind it; the one before ends in front of it.
        around = (names[index - 1], names[index])
        own = _ways(plan, node, road, around, first_id=first_id + len(ways))
        number = numbers[node, road]
        junctions.append(junction_of(number, f"Roundabout {node}: road {road}", own))
        ways.extend(own)
    return Crossing(tuple(ways), tuple(junctions), tuple(roads))


def _half_gap(plan: StreetPlan, ring: RoundaboutPlan) -> float:
    """Angle at the centre between a street and where its ways touch the ring [rad]."""
    # The arc of an entry touches the ring from outside and the middle of the lane of the street.
    offset = 0.5 * plan.cross_section.lane + ring.entry_radius
    return float(np.arcsin(offset / (ring.radius + ring.entry_radius)))


def _on_ring(plan: StreetPlan, node: str, angle: float) -> Pose:
    away = np.array([np.cos(angle), np.sin(angle)])
    point = np.array(plan.nodes[node]) + plan.roundabouts[node].radius * away
    return Pose(point, np.array([-away[1], away[0]]))


def _bearing(plan: StreetPlan, node: str, road: str) -> float:
    direction = outward(plan, road, node).direction
    return float(np.arctan2(direction[1], direction[0]))


def _ring_roads(plan: StreetPlan, node: str, names: list[str]) -> list[Road]:
    ring = plan.roundabouts[node]
    half_gap = _half_gap(plan, ring)
    numbers = [ring_junctions(plan)[node, road] for road in ring.arms]
    bearings = [_bearing(plan, node, road) for road in ring.arms]
    gaps = [(there - here) % (2.0 * np.pi) for here, there in pairwise([*bearings, bearings[0]])]
    spans = [gap - 2.0 * half_gap for gap in gaps]
    least_gap = 2.0 * half_gap + _SHORTEST_RING_ROAD / ring.radius
    if min(gaps) < least_gap or not np.isclose(sum(gaps), 2.0 * np.pi):
        raise TownFormatError(
            f"Roundabout '{node}' has streets at {', '.join(f'{np.degrees(b):.0f}' for b in bearings)} degrees; "
            f"expected them counter-clockwise and at least {np.degrees(least_gap):.0f} degrees apart. "
            "Sort its arms, or take a larger radius or a smaller entry_radius."
        )
    return [
        _one_way(
            name,
            turn_left(
                _on_ring(plan, node, bearing + half_gap), radius=ring.radius, angle=float(span)
            ),
            (
                RoadLink("junction", numbers[index]),
                RoadLink("junction", numbers[(index + 1) % len(numbers)]),
            ),
            plan,
        )
        for index, (name, bearing, span) in enumerate(zip(names, bearings, spans, strict=True))
    ]


def _ways(
    plan: StreetPlan, node: str, road: str, around: tuple[str, str], *, first_id: int
) -> list[Road]:
    """Draw the ways in, out and past at a street."""
    ring = plan.roundabouts[node]
    width, half_gap = plan.cross_section.lane, _half_gap(plan, ring)
    bearing = _bearing(plan, node, road)
    before, behind = (_on_ring(plan, node, bearing + side * half_gap) for side in (-1.0, 1.0))
    what = f"Roundabout '{node}' at road '{road}'"
    way_in = join(
        inward(plan, road, node).to_the_right(width / 2),
        behind,
        radius=ring.entry_radius,
        what=what,
    )
    way_out = join(
        before,
        outward(plan, road, node).to_the_right(width / 2),
        radius=ring.entry_radius,
        what=what,
    )
    past = turn_left(before, radius=ring.radius, angle=2.0 * half_gap)
    street = RoadLink("road", road, contact(plan, road, node))
    come, go = RoadLink("road", around[0], "end"), RoadLink("road", around[1], "start")
    junction = ring_junctions(plan)[node, road]
    drawn = (("in", way_in, street, go), ("out", way_out, come, street), ("past", past, come, go))
    return [
        connecting_road(
            str(first_id + index),
            name=f"Roundabout {node}: {name} at road {road}",
            junction=junction,
            pieces=pieces,
            links=(link_before, link_behind),
            width=width,
        )
        for index, (name, pieces, link_before, link_behind) in enumerate(drawn)
    ]


def _one_way(
    road: str, pieces: tuple[Piece, ...], links: tuple[RoadLink, RoadLink], plan: StreetPlan
) -> Road:
    """A road with one lane, whose middle is the reference line, between an island and a sidewalk."""
    widths = plan.cross_section

    def lane(number: int, kind: str, width: float) -> LaneRecord:
        marks = (_KERB_MARK,) if kind == "shoulder" else ()
        return LaneRecord(number, kind, (Cubic(0.0, width),), marks=marks)

    lanes = (
        lane(1, "shoulder", widths.shoulder),
        LaneRecord(0, "none"),
        lane(-1, "driving", widths.lane),
        lane(-2, "shoulder", widths.shoulder),
        lane(-3, "sidewalk", widths.sidewalk),
    )
    return Road(
        id=road,
        name=f"Ring {road}",
        length=length_of(pieces),
        junction=None,
        pieces=pieces,
        lane_offsets=(Cubic(0.0, widths.lane / 2),),
        sections=(LaneSection(0.0, lanes),),
        predecessor=links[0],
        successor=links[1],
    )
