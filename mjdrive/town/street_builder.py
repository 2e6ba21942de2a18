"""From a street plan to an OpenDRIVE map."""

from dataclasses import replace
from itertools import pairwise, permutations

import numpy as np
from jaxtyping import Float

from mjdrive.town.fillet import Pose, extend, join, length_of
from mjdrive.town.network import TRAFFIC_LIGHT_TYPE
from mjdrive.town.road_map import (
    Connection,
    Junction,
    LaneRecord,
    LaneSection,
    Road,
    RoadLink,
    RoadMap,
    SignalRecord,
)
from mjdrive.town.road_shapes import Cubic, Piece, RoadMark
from mjdrive.town.street_plan import CornerPlan, CrossSection, JunctionPlan, LightPlan, StreetPlan

_CENTRE_MARK = RoadMark("broken", "yellow", 0.125)
_KERB_MARK = RoadMark("curb", "standard", 0.152)
_FIRST_CONNECTING_ROAD = 1000


def build_map(plan: StreetPlan) -> RoadMap:
    """Draw the map of a street plan.

    Args:
        plan: The street plan.

    Returns:
        Streets, corners, and a connecting road for each way through each junction.

    Raises:
        TownFormatError: If a turn does not fit into its junction.
    """
    roads = {road: _street(plan, road) for road in plan.streets}
    for node, corner in plan.corners.items():
        roads[node] = _corner(plan, node, corner)
    junctions, controllers = {}, {}
    next_id = _FIRST_CONNECTING_ROAD
    for node, crossing in plan.junctions.items():
        ways = [
            _way(plan, node, *pair, road=str(next_id + i))
            for i, pair in enumerate(permutations(crossing.arms, 2))
        ]
        next_id += len(ways)
        roads |= {way.id: way for way in ways}
        for light in crossing.lights:
            controllers[light.id] = (light.id,)
            approach = roads[light.road]
            roads[light.road] = replace(
                approach, signals=(*approach.signals, _signal(plan, node, light, approach))
            )
        junctions[node] = _junction(node, crossing, ways)
    return RoadMap(plan.name, roads, junctions, controllers)


def _arms(plan: StreetPlan, node: str) -> dict[str, float]:
    return plan.corners[node].arms if node in plan.corners else plan.junctions[node].arms


def _outward(plan: StreetPlan, road: str, node: str) -> Pose:
    """Where the middle of a street leaves a node, looking away from it."""
    corners = _corners(plan, road)
    here, there = corners[:2] if node == plan.streets[road][0] else corners[:-3:-1]
    direction = (there - here) / np.hypot(*(there - here))
    return Pose(here + _arms(plan, node)[road] * direction, direction)


def _corners(plan: StreetPlan, road: str) -> list[Float[np.ndarray, "2"]]:
    """Ends and bends of a street, in its direction [m]."""
    start, end = plan.streets[road]
    return [
        np.array(point) for point in (plan.nodes[start], *plan.bends.get(road, ()), plan.nodes[end])
    ]


def _inward(plan: StreetPlan, road: str, node: str) -> Pose:
    point, direction = _outward(plan, road, node)
    return Pose(point, -direction)


def _contact(plan: StreetPlan, road: str, node: str) -> str:
    """Which end of a street lies at a node."""
    return "start" if plan.streets[road][0] == node else "end"


def _street(plan: StreetPlan, road: str) -> Road:
    start, end = plan.streets[road]
    corners = _corners(plan, road)
    # Half way between two bends a street is straight: each bend is joined from half way to half way.
    half_ways = [
        Pose(0.5 * (here + there), (there - here) / np.hypot(*(there - here)))
        for here, there in pairwise(corners[1:-1])
    ]
    poses = [_outward(plan, road, start), *half_ways, _inward(plan, road, end)]
    pieces: tuple[Piece, ...] = ()
    for here, there in pairwise(poses):
        run = join(here, there, radius=None, what=f"Street '{road}'")
        pieces = extend(pieces, run)
    links = [_link_at(plan, road, node) for node in (start, end)]
    return _two_way(road, pieces, links[0], links[1], plan.cross_section)


def _link_at(plan: StreetPlan, road: str, node: str) -> RoadLink:
    if node in plan.junctions:
        return RoadLink("junction", node)
    return RoadLink("road", node, "start" if road == next(iter(plan.corners[node].arms)) else "end")


def _corner(plan: StreetPlan, node: str, corner: CornerPlan) -> Road:
    come, go = corner.arms
    pieces = join(
        _inward(plan, come, node),
        _outward(plan, go, node),
        radius=corner.radius,
        what=f"Corner '{node}'",
    )
    links = [RoadLink("road", road, _contact(plan, road, node)) for road in (come, go)]
    return _two_way(node, pieces, links[0], links[1], plan.cross_section)


def _two_way(
    road: str, pieces: tuple[Piece, ...], before: RoadLink, behind: RoadLink, widths: CrossSection
) -> Road:
    def linked(number: int, link: RoadLink, side: str) -> int | None:
        if link.kind == "junction":
            return None
        # Two starts or two ends that meet look at each other: what is left of one is right of the other.
        return -number if link.contact == side else number

    outer = (("driving", widths.lane), ("shoulder", widths.shoulder), ("sidewalk", widths.sidewalk))
    lanes = [LaneRecord(0, "none", marks=(_CENTRE_MARK,))]
    for side in (1, -1):
        for rank, (kind, width) in enumerate(outer, start=1):
            number = side * rank
            lanes.append(
                LaneRecord(
                    id=number,
                    type=kind,
                    widths=(Cubic(0.0, width),),
                    predecessor=linked(number, before, "start"),
                    successor=linked(number, behind, "end"),
                    marks=(_KERB_MARK,) if kind == "shoulder" else (),
                )
            )
    lanes.sort(key=lambda lane: -lane.id)
    return Road(
        id=road,
        name=f"Road {road}",
        length=length_of(pieces),
        junction=None,
        pieces=pieces,
        lane_offsets=(Cubic(0.0, 0.0),),
        sections=(LaneSection(0.0, tuple(lanes)),),
        predecessor=before,
        successor=behind,
    )


def _way(plan: StreetPlan, node: str, come: str, go: str, *, road: str) -> Road:
    """Draw a connecting road: one lane whose middle is the reference line."""
    width = plan.cross_section.lane
    radii = {(turn.come, turn.go): turn.radius for turn in plan.junctions[node].turns}
    pieces = join(
        _inward(plan, come, node).to_the_right(width / 2),
        _outward(plan, go, node).to_the_right(width / 2),
        radius=radii.get((come, go)),
        what=f"The way from road '{come}' to road '{go}' through junction '{node}'",
    )
    before = RoadLink("road", come, _contact(plan, come, node))
    behind = RoadLink("road", go, _contact(plan, go, node))
    lane = LaneRecord(
        id=-1,
        type="driving",
        widths=(Cubic(0.0, width),),
        predecessor=-1 if before.contact == "end" else 1,
        successor=-1 if behind.contact == "start" else 1,
    )
    return Road(
        id=road,
        name=f"Junction {node}: {come} to {go}",
        length=length_of(pieces),
        junction=node,
        pieces=pieces,
        lane_offsets=(Cubic(0.0, width / 2),),
        sections=(LaneSection(0.0, (LaneRecord(0, "none"), lane)),),
        predecessor=before,
        successor=behind,
    )


def _junction(node: str, crossing: JunctionPlan, ways: list[Road]) -> Junction:
    connections = []
    for index, way in enumerate(ways):
        lane = way.sections[0].lanes[-1]
        assert way.predecessor is not None
        assert lane.predecessor is not None
        connections.append(
            Connection(
                str(index), way.predecessor.id, way.id, "start", ((lane.predecessor, lane.id),)
            )
        )
    return Junction(
        node, f"Junction {node}", tuple(connections), tuple(light.id for light in crossing.lights)
    )


def _signal(plan: StreetPlan, node: str, light: LightPlan, road: Road) -> SignalRecord:
    lane = -1 if _contact(plan, light.road, node) == "end" else 1
    line = road.pieces[-1] if lane < 0 else road.pieces[0]
    along = np.array([np.cos(line.heading), np.sin(line.heading)])
    relative = np.array(light.pole) - np.array([line.x, line.y])
    return SignalRecord(
        id=light.id,
        name=f"Light {light.id}",
        type=TRAFFIC_LIGHT_TYPE,
        # A pole may stand a little behind the end of its road; the standard keeps s on the road.
        s=round(float(np.clip(line.s + relative @ along, 0.0, road.length)), 9),
        t=round(float(along[0] * relative[1] - along[1] * relative[0]), 9),
        orientation="+" if lane < 0 else "-",
        from_lane=lane,
        to_lane=lane,
    )
