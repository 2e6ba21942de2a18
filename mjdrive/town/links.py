"""How the lanes of an OpenDRIVE map hang together."""

from collections import defaultdict
from typing import NamedTuple

from mjdrive.errors import TownFormatError
from mjdrive.town.opendrive.cross_section import section_bounds
from mjdrive.town.opendrive.road_map import Connection, LaneRecord, Road, RoadLink, RoadMap
from mjdrive.town.opendrive.vocabulary import DRIVEN_LANE_TYPES

SHORTEST_SECTION = 0.001
"""Lane sections below this length are passed through as if they were not there [m]."""


class LaneKey(NamedTuple):
    """Where a lane is written in the map: road id, section index and lane number."""

    road: str
    section: int
    lane: int

    @property
    def name(self) -> str:
        """How a `Lane` is called."""
        return f"{self.road}/{self.section}/{self.lane}"


def runs_along(road: Road, record: LaneRecord) -> bool:
    """Tell whether traffic on a lane moves along s.

    Right of the reference line it does where traffic keeps to the right, left of it where traffic keeps to the
    left, and "reversed" lanes turn that round. Lanes for "both" directions are driven in that of their side.
    """
    return ((record.id < 0) != road.drives_on_left) != (record.direction == "reversed")


class Links:
    """Finds what follows and what lies beside each driven lane.

    Args:
        road_map: The OpenDRIVE map.

    Attributes:
        following: What follows each driven lane, in the order of the map.
        before: What lies before each driven lane.

    Raises:
        TownFormatError: If a link leads to a road or junction that the map does not have.
    """

    def __init__(self, road_map: RoadMap) -> None:
        self._map = road_map
        self._records = {
            LaneKey(road.id, index, record.id): record
            for road in road_map.roads.values()
            for index, section in enumerate(road.sections)
            for record in section.lanes
            if record.id != 0 and record.type in DRIVEN_LANE_TYPES
        }
        self._ways: dict[tuple[str, str], list[Connection]] = defaultdict(list)
        for junction in road_map.junctions.values():
            for connection in junction.connections:
                self._ways[junction.id, connection.incoming].append(connection)
        driven = [key for key in self._records if not self._is_empty(key)]
        self.following = {key: self._successors(key) for key in driven}
        self.before: dict[LaneKey, list[LaneKey]] = {key: [] for key in driven}
        for key, ways in self.following.items():
            for way in ways:
                self.before[way].append(key)

    def runs_along(self, key: LaneKey) -> bool:
        """Tell whether traffic on a driven lane moves along s."""
        return runs_along(self._map.roads[key.road], self._records[key])

    def neighbours(self, key: LaneKey) -> tuple[LaneKey | None, LaneKey | None]:
        """Find the driven lanes beside a lane in the same direction, on its left and on its right."""
        ids = [lane.id for lane in self._section(key) if lane.id != 0]
        index = ids.index(key.lane)
        beside = [
            self._same_way(key, ids[there]) if 0 <= there < len(ids) else None
            for there in (index - 1, index + 1)
        ]
        # Lanes are listed from left to right as seen along s.
        left, right = beside if self.runs_along(key) else reversed(beside)
        return left, right

    def junction_behind(self, key: LaneKey) -> str | None:
        """Name the junction that the road of a lane leads into at the end of the lane, or None."""
        last = len(self._map.roads[key.road].sections) - 1 if self.runs_along(key) else 0
        link = self._link(key) if key.section == last else None
        return link.id if link is not None and link.kind == "junction" else None

    def _successors(self, key: LaneKey) -> list[LaneKey]:
        """Find the lanes that follow, each once: in the road, on the next road or across a junction."""
        found: dict[LaneKey, None] = {}
        passed: set[LaneKey] = set()
        ahead = self._following(key)
        while ahead:
            following = ahead.pop(0)
            if not self._is_empty(following):
                found[following] = None
            elif following not in passed:
                passed.add(following)
                ahead = self._following(following) + ahead
        return list(found)

    def _same_way(self, key: LaneKey, number: int) -> LaneKey | None:
        other = key._replace(lane=number)
        same = other in self._records and self.runs_along(other) == self.runs_along(key)
        return other if same else None

    def _section(self, key: LaneKey) -> tuple[LaneRecord, ...]:
        return self._map.roads[key.road].sections[key.section].lanes

    def _is_empty(self, key: LaneKey) -> bool:
        start, end = section_bounds(self._map.roads[key.road], key.section)
        return end - start < SHORTEST_SECTION

    def _link(self, key: LaneKey) -> RoadLink | None:
        road = self._map.roads[key.road]
        return road.successor if self.runs_along(key) else road.predecessor

    def _following(self, key: LaneKey) -> list[LaneKey]:
        """Follow the link at the end of a lane, to lanes of any length that are entered at their start."""
        forward = self.runs_along(key)
        record = self._records[key]
        linked = record.successor if forward else record.predecessor
        section = key.section + (1 if forward else -1)
        if 0 <= section < len(self._map.roads[key.road].sections):
            found = [] if linked is None else [LaneKey(key.road, section, linked)]
            return self._entered(found, "start" if forward else "end")
        link = self._link(key)
        if link is None:
            return []
        if link.kind == "junction":
            return self._across(key, link.id)
        if linked is None:
            self._road(link.id, f"Road '{key.road}' leads")
            return []
        return self._at_contact(
            link.id, link.contact or "start", linked, f"Road '{key.road}' leads"
        )

    def _across(self, key: LaneKey, junction: str) -> list[LaneKey]:
        if junction not in self._map.junctions:
            raise TownFormatError(
                f"Road '{key.road}' leads to junction '{junction}', which the map does not have."
            )
        who = f"Junction '{junction}' leads"
        return [
            following
            for connection in self._ways[junction, key.road]
            for here, there in connection.lane_links
            if here == key.lane
            for following in self._at_contact(connection.connecting, connection.contact, there, who)
        ]

    def _at_contact(self, road_id: str, contact: str, lane: int, who: str) -> list[LaneKey]:
        last = len(self._road(road_id, who).sections) - 1
        return self._entered([LaneKey(road_id, 0 if contact == "start" else last, lane)], contact)

    def _entered(self, keys: list[LaneKey], contact: str) -> list[LaneKey]:
        """Keep the driven lanes that begin where they are met: a link may name the lane of the way back too."""
        along = contact == "start"
        return [key for key in keys if key in self._records and self.runs_along(key) == along]

    def _road(self, road_id: str, who: str) -> Road:
        if road_id not in self._map.roads:
            raise TownFormatError(f"{who} to road '{road_id}', which the map does not have.")
        return self._map.roads[road_id]
