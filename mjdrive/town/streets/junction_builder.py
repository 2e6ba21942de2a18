"""The ways across the junctions of a street plan."""

from itertools import permutations
from typing import NamedTuple

import numpy as np

from mjdrive.town.opendrive.road_map import (
    Connection,
    Junction,
    LaneRecord,
    LaneSection,
    Road,
    RoadLink,
)
from mjdrive.town.opendrive.road_shapes import Cubic, Piece
from mjdrive.town.streets.fillet import Pose, join, length_of
from mjdrive.town.streets.street_ends import contact, inward, outward
from mjdrive.town.streets.street_plan import StreetPlan

_STRAIGHT_BELOW = np.pi / 4
"""Largest change of heading of a way straight through [rad]."""


class Crossing(NamedTuple):
    """What is built at a node.

    Attributes:
        ways: Connecting roads.
        junctions: Junctions that they belong to.
        ring: Roads between the junctions of a roundabout.
    """

    ways: tuple[Road, ...]
    junctions: tuple[Junction, ...]
    ring: tuple[Road, ...] = ()


def build_junction(plan: StreetPlan, node: str, *, first_id: int) -> Crossing:
    """Draw a way from each street that meets at a junction to each other.

    Args:
        plan: The street plan.
        node: Node of the junction.
        first_id: Number of the first connecting road.

    Returns:
        The connecting roads and their junction.

    Raises:
        TownFormatError: If a turn does not fit.
    """
    crossing = plan.junctions[node]
    ways = [
        _way(plan, node, *pair, road=str(first_id + index))
        for index, pair in enumerate(permutations(crossing.arms, 2))
    ]
    lights = tuple(light.id for light in crossing.lights)
    return Crossing(tuple(ways), (junction_of(node, f"Junction {node}", ways, lights),))


def _way(plan: StreetPlan, node: str, come: str, go: str, *, road: str) -> Road:
    width = plan.cross_section.lane
    start = inward(plan, come, node).to_the_right(width / 2)
    end = outward(plan, go, node).to_the_right(width / 2)
    listed = {(turn.come, turn.go): turn.radius for turn in plan.junctions[node].turns}
    pieces = join(
        start,
        end,
        radius=listed.get((come, go), _usual_radius(plan, start, end)),
        what=f"The way from road '{come}' to road '{go}' through junction '{node}'",
    )
    before = RoadLink("road", come, contact(plan, come, node))
    behind = RoadLink("road", go, contact(plan, go, node))
    return connecting_road(
        road,
        name=f"Junction {node}: {come} to {go}",
        junction=node,
        pieces=pieces,
        links=(before, behind),
        width=width,
    )


def _usual_radius(plan: StreetPlan, start: Pose, end: Pose) -> float | None:
    """Radius of a turn that the junction does not list [m]; None straight through."""
    (ahead_x, ahead_y), (out_x, out_y) = start.direction, end.direction
    turn = np.arctan2(ahead_x * out_y - ahead_y * out_x, ahead_x * out_x + ahead_y * out_y)
    if abs(turn) < _STRAIGHT_BELOW:
        return None
    return plan.turn_radii.left if turn > 0.0 else plan.turn_radii.right


def connecting_road(
    road: str,
    *,
    name: str,
    junction: str,
    pieces: tuple[Piece, ...],
    links: tuple[RoadLink, RoadLink],
    width: float,
) -> Road:
    """Build a road across a junction: one lane whose middle is the reference line.

    Args:
        road: Its id.
        name: Its name.
        junction: Id of the junction.
        pieces: Its reference line.
        links: What lies before and behind.
        width: Of the lane [m].

    Returns:
        The road.
    """
    before, behind = links
    lane = LaneRecord(
        id=-1,
        type="driving",
        widths=(Cubic(0.0, width),),
        predecessor=-1 if before.contact == "end" else 1,
        successor=-1 if behind.contact == "start" else 1,
    )
    return Road(
        id=road,
        name=name,
        length=length_of(pieces),
        junction=junction,
        pieces=pieces,
        lane_offsets=(Cubic(0.0, width / 2),),
        sections=(LaneSection(0.0, (LaneRecord(0, "none"), lane)),),
        predecessor=before,
        successor=behind,
    )


def junction_of(
    junction: str, name: str, ways: list[Road], controllers: tuple[str, ...] = ()
) -> Junction:
    """Build the junction that connecting roads belong to.

    Args:
        junction: Its id.
        name: Its name.
        ways: The connecting roads.
        controllers: Ids of its signal controllers, in the order of their turns.

    Returns:
        The junction, with a connection for each way.
    """
    connections = []
    for index, way in enumerate(ways):
        lane = way.sections[0].lanes[-1]
        assert way.predecessor is not None
        assert lane.predecessor is not None
        links = ((lane.predecessor, lane.id),)
        connections.append(Connection(str(index), way.predecessor.id, way.id, "start", links))
    return Junction(junction, name, tuple(connections), controllers)
