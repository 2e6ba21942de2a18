"""From a street plan to an OpenDRIVE map."""

from collections import defaultdict
from dataclasses import replace
from itertools import pairwise

import numpy as np

from mjdrive.town.opendrive.road_map import (
    Junction,
    LaneRecord,
    LaneSection,
    Road,
    RoadLink,
    RoadMap,
    SignalRecord,
)
from mjdrive.town.opendrive.road_shapes import Cubic, Piece, RoadMark
from mjdrive.town.streets.fillet import Pose, extend, join, length_of
from mjdrive.town.streets.junction_builder import Crossing, build_junction
from mjdrive.town.streets.roadside import light_signal, sign_signal
from mjdrive.town.streets.roundabout import build_roundabout
from mjdrive.town.streets.street_ends import contact, corners_of, inward, outward, ring_junctions
from mjdrive.town.streets.street_plan import CornerPlan, CrossSection, StreetPlan

_CENTRE_MARK = RoadMark("broken", "yellow", 0.125)
_KERB_MARK = RoadMark("curb", "standard", 0.152)
_FIRST_CONNECTING_ROAD = 1000


def build_map(plan: StreetPlan) -> RoadMap:
    """Draw the map of a street plan.

    Args:
        plan: The street plan.

    Returns:
        Streets, corners, rings, and a connecting road for each way through each junction.

    Raises:
        TownFormatError: If a turn does not fit into its junction.
    """
    roads = {road: _street(plan, road) for road in plan.streets}
    for node, corner in plan.corners.items():
        roads[node] = _corner(plan, node, corner)
    signals = _signals(plan, roads)
    roads = {
        name: replace(road, signals=tuple(signals[name])) if name in signals else road
        for name, road in roads.items()
    }
    junctions: dict[str, Junction] = {}
    next_id = _FIRST_CONNECTING_ROAD
    crossings = [(build_junction, node) for node in plan.junctions]
    for build, node in [*crossings, *((build_roundabout, node) for node in plan.roundabouts)]:
        crossing: Crossing = build(plan, node, first_id=next_id)
        next_id += len(crossing.ways)
        roads |= {road.id: road for road in (*crossing.ring, *crossing.ways)}
        junctions |= {junction.id: junction for junction in crossing.junctions}
    controllers = {
        light.id: (light.id,) for junction in plan.junctions.values() for light in junction.lights
    }
    return RoadMap(plan.name, roads, junctions, controllers)


def _signals(plan: StreetPlan, roads: dict[str, Road]) -> dict[str, list[SignalRecord]]:
    """Lights and signs beside each street, by road."""
    signals = defaultdict(list)
    for node, junction in plan.junctions.items():
        for light in junction.lights:
            signals[light.road].append(light_signal(plan, node, light, roads[light.road]))
    for sign in plan.signs:
        signals[sign.road].append(sign_signal(sign, roads[sign.road]))
    return signals


def _street(plan: StreetPlan, road: str) -> Road:
    start, end = plan.streets[road]
    corners = corners_of(plan, road)
    # Half way between two bends a street is straight: each bend is joined from half way to half way.
    half_ways = [
        Pose(0.5 * (here + there), (there - here) / np.hypot(*(there - here)))
        for here, there in pairwise(corners[1:-1])
    ]
    poses = [outward(plan, road, start), *half_ways, inward(plan, road, end)]
    pieces: tuple[Piece, ...] = ()
    for here, there in pairwise(poses):
        run = join(here, there, radius=None, what=f"Street '{road}'")
        pieces = extend(pieces, run)
    links = [_link_at(plan, road, node) for node in (start, end)]
    return _two_way(road, pieces, links[0], links[1], plan.cross_section)


def _link_at(plan: StreetPlan, road: str, node: str) -> RoadLink:
    if node in plan.corners:
        first = next(iter(plan.corners[node].arms))
        return RoadLink("road", node, "start" if road == first else "end")
    return RoadLink("junction", ring_junctions(plan).get((node, road), node))


def _corner(plan: StreetPlan, node: str, corner: CornerPlan) -> Road:
    come, go = corner.arms
    pieces = join(
        inward(plan, come, node),
        outward(plan, go, node),
        radius=corner.radius,
        what=f"Corner '{node}'",
    )
    links = [RoadLink("road", road, contact(plan, road, node)) for road in (come, go)]
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
