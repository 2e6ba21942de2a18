"""Lane after lane, each way at a junction with the same probability."""

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from mjdrive.datatypes import Town
from mjdrive.errors import RouteError, UnknownNameError
from mjdrive.town.lane_graph import lane_length, onward

Choose = Callable[[Sequence[str]], str]
"""Takes one of the lanes that lead on."""

_ROUNDING = 1e-6
"""Lengths that are added up in another order may differ by this [m]."""


def random_lanes(
    town: Town,
    *,
    lane: str,
    station: float,
    length: float,
    rng: np.random.Generator,
    choose: Choose | None = None,
) -> Iterator[str]:
    """Name the lanes of a random walk, until it comes to a dead end.

    Args:
        town: The town.
        lane: Name of the lane to start on; it comes first.
        station: Where on it to start [m].
        length: Ways that come to a dead end before this length are left out; with infinity, all dead ends [m].
        rng: Source of the choices, one draw for each lane that follows.
        choose: Chooses instead of chance.

    Raises:
        UnknownNameError: If there is no such lane.
        RouteError: If the station is not on the lane, or every way comes to a dead end before that length.
    """
    if lane not in town.lanes:
        raise UnknownNameError("lane", lane, town.lanes)
    first = lane_length(town.lanes[lane])
    if not 0.0 <= station <= first:
        raise RouteError(
            f"Station {station} m is not on lane '{lane}'; expected 0 to {first:.2f} m."
        )
    left = length - (first - station)
    ahead = onward(town)[lane]
    if ahead < left:
        raise RouteError(
            f"From station {station:.1f} m of lane '{lane}' the lanes lead on for {first - station + ahead:.1f} m; "
            f"expected {length:.1f} m. Drive less far (fewer --steps) or start elsewhere (another --seed)."
        )
    return _walk(town, lane, left, choose or (lambda ways: ways[int(rng.integers(len(ways)))]))


def _walk(town: Town, lane: str, left: float, choose: Choose) -> Iterator[str]:
    """Go on from lane to lane; `left` is how far the walk must lead beyond the lane [m]."""
    ahead = onward(town)
    while True:
        yield lane
        ways = [
            name
            for name in town.lanes[lane].successors
            if lane_length(town.lanes[name]) + ahead[name] >= left - _ROUNDING
        ]
        if not ways:
            return
        lane = choose(ways)
        left -= lane_length(town.lanes[lane])
