"""Shortest ways along the lanes of a town."""

import heapq
import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from types import MappingProxyType
from typing import NamedTuple

from mjdrive.datatypes import Lane, Town
from mjdrive.geometry import stations


class Place(NamedTuple):
    """A point on the centre line of a lane.

    Attributes:
        lane: Name of the lane.
        station: Arc length from its start [m].
    """

    lane: str
    station: float


class Leg(NamedTuple):
    """The shortest way from one place to another.

    Attributes:
        length: Distance along the lanes [m].
        entered: Names of the lanes that are entered on the way, the last one included.
    """

    length: float
    entered: tuple[str, ...]


@lru_cache(maxsize=20_000)
def lane_length(lane: Lane) -> float:
    """Length of a lane along its centre line [m]."""
    return float(stations(lane.centerline)[-1])


@lru_cache(maxsize=4)
def onward(town: Town) -> Mapping[str, float]:
    """Tell how far one can drive on beyond the end of each lane.

    Args:
        town: The town.

    Returns:
        Length of the longest way by lane name, infinite where lanes lead round in a circle [m].
    """
    before: dict[str, list[str]] = {name: [] for name in town.lanes}
    open_ways = {name: len(set(lane.successors)) for name, lane in town.lanes.items()}
    for name, lane in town.lanes.items():
        for following in set(lane.successors):
            before[following].append(name)
    farthest = dict.fromkeys(town.lanes, 0.0)
    # From the dead ends back; what is never reached so leads into a circle.
    done = [name for name, ways in open_ways.items() if ways == 0]
    for name in done:
        length = lane_length(town.lanes[name]) + farthest[name]
        for behind in before[name]:
            farthest[behind] = max(farthest[behind], length)
            open_ways[behind] -= 1
            if open_ways[behind] == 0:
                done.append(behind)
    ended = set(done)
    return MappingProxyType(
        {name: farthest[name] if name in ended else math.inf for name in town.lanes}
    )


def round_trips(town: Town) -> list[list[str]]:
    """Find the parts of a town in which one can drive from every lane to every lane.

    Args:
        town: The town.

    Returns:
        Names of the lanes of each part, in the order of the town. Lanes on no round trip are in none.

    Reference:
        Kosaraju's algorithm, after Sharir, A strong-connectivity algorithm, 1981.
    """
    before: dict[str, list[str]] = {name: [] for name in town.lanes}
    for name, lane in town.lanes.items():
        for following in lane.successors:
            before[following].append(name)
    onward_ways = {name: lane.successors for name, lane in town.lanes.items()}
    seen: set[str] = set()
    finished = [name for start in town.lanes for name in _post_order(start, onward_ways, seen)]
    seen = set()
    parts = [_post_order(start, before, seen) for start in reversed(finished)]
    place = {name: index for index, name in enumerate(town.lanes)}
    return [
        sorted(part, key=place.__getitem__)
        for part in parts
        if len(part) > 1 or (part and part[0] in town.lanes[part[0]].successors)
    ]


def _post_order(start: str, ways: Mapping[str, Sequence[str]], seen: set[str]) -> list[str]:
    """Visit what can be reached and was not seen before, depth first; each comes after all that it leads to."""
    if start in seen:
        return []
    seen.add(start)
    order = []
    path = [(start, iter(ways[start]))]
    while path:
        name, ahead = path[-1]
        following = next((way for way in ahead if way not in seen), None)
        if following is None:
            order.append(name)
            path.pop()
        else:
            seen.add(following)
            path.append((following, iter(ways[following])))
    return order


class LaneGraph:
    """The lanes of a town as a directed graph; remembers the shortest paths that it has found.

    Args:
        town: The town.
    """

    def __init__(self, town: Town) -> None:
        self._town = town
        self._lengths = {name: lane_length(lane) for name, lane in town.lanes.items()}
        self._searches: dict[str, _Search] = {}

    def leg(self, start: Place, end: Place) -> Leg | None:
        """Find the shortest way between two places.

        Args:
            start: Where it begins.
            end: Where it ends.

        Returns:
            The way, or None if the lanes do not lead there.
        """
        if start.lane == end.lane and end.station >= start.station:
            return Leg(end.station - start.station, ())
        if start.lane not in self._searches:
            self._searches[start.lane] = _Search(self._town, self._lengths, start.lane)
        tree = self._searches[start.lane].tree_with(end.lane)
        if end.lane not in tree:
            return None
        entered = [end.lane]
        while (before := tree[entered[-1]][1]) != start.lane:
            entered.append(before)
        length = self._lengths[start.lane] - start.station + tree[end.lane][0] + end.station
        return Leg(length, tuple(reversed(entered)))


class _Search:
    """Dijkstra from the end of a lane, as far as it has been asked for.

    Args:
        town: The town.
        lengths: Of its lanes [m].
        start: Name of the lane.
    """

    def __init__(self, town: Town, lengths: Mapping[str, float], start: str) -> None:
        self._town, self._lengths = town, lengths
        self._tree: dict[str, tuple[float, str]] = {}
        self._queue = [(0.0, name, start) for name in town.lanes[start].successors]
        heapq.heapify(self._queue)

    def tree_with(self, wanted: str) -> Mapping[str, tuple[float, str]]:
        """Distance to the start of each lane found so far [m], and the lane before it; all there are if one cannot be reached."""
        while self._queue and wanted not in self._tree:
            distance, name, before = heapq.heappop(self._queue)
            if name not in self._tree:
                self._tree[name] = (distance, before)
                for following in self._town.lanes[name].successors:
                    heapq.heappush(self._queue, (distance + self._lengths[name], following, name))
        return self._tree
