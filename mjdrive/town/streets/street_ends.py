"""Where the streets of a plan end, and what they meet there."""

import numpy as np
from jaxtyping import Float

from mjdrive.town.streets.fillet import Pose
from mjdrive.town.streets.street_plan import StreetPlan

_FIRST_RING_JUNCTION = 5000
"""Number of the first junction between a street and the ring of a roundabout."""


def outward(plan: StreetPlan, road: str, node: str) -> Pose:
    """Where the middle of a street leaves a node, looking away from it."""
    corners = corners_of(plan, road)
    here, there = corners[:2] if node == plan.streets[road][0] else corners[:-3:-1]
    direction = (there - here) / np.hypot(*(there - here))
    return Pose(here + _arms(plan, node)[road] * direction, direction)


def inward(plan: StreetPlan, road: str, node: str) -> Pose:
    """Where the middle of a street leaves a node, looking at it."""
    point, direction = outward(plan, road, node)
    return Pose(point, -direction)


def corners_of(plan: StreetPlan, road: str) -> list[Float[np.ndarray, "2"]]:
    """Ends and bends of a street, in its direction [m]."""
    start, end = plan.streets[road]
    return [
        np.array(point) for point in (plan.nodes[start], *plan.bends.get(road, ()), plan.nodes[end])
    ]


def contact(plan: StreetPlan, road: str, node: str) -> str:
    """Which end of a street lies at a node."""
    return "start" if plan.streets[road][0] == node else "end"


def ring_junctions(plan: StreetPlan) -> dict[tuple[str, str], str]:
    """Number the junctions between streets and rings, by node of the roundabout and road."""
    places = [(node, road) for node, ring in plan.roundabouts.items() for road in ring.arms]
    return {place: str(_FIRST_RING_JUNCTION + index) for index, place in enumerate(places)}


def _arms(plan: StreetPlan, node: str) -> dict[str, float]:
    for kind in (plan.corners, plan.junctions, plan.roundabouts):
        if node in kind:
            return kind[node].arms
    raise AssertionError(f"node {node} is nothing")
