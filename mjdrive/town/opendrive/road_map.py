"""The road network as OpenDRIVE describes it: plain facts, in the words of the standard.

Reference:
    ASAM OpenDRIVE 1.4. Names follow its elements; `s` runs along the reference line of a road and `t` to its left.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from mjdrive.town.opendrive.road_shapes import Cubic, Piece, RoadMark


@dataclass(frozen=True, slots=True)
class LaneRecord:
    """One lane of a lane section.

    Attributes:
        id: 0 in the middle, positive to the left, negative to the right.
        type: "driving", "shoulder", "sidewalk", "none" and others.
        widths: Width along the section; empty for lane 0 and where `borders` are given.
        predecessor: Lane id at the start, on what lies before.
        successor: Lane id at the end, on what lies behind.
        marks: Marks along the outer edge, in order of their starts.
        borders: Outer edge from the reference line, positive to the left; used where there are no `widths`.
        direction: Travel: "standard" with the rule of the road, "reversed" against it, or "both".
    """

    id: int
    type: str
    widths: tuple[Cubic, ...] = ()
    predecessor: int | None = None
    successor: int | None = None
    marks: tuple[RoadMark, ...] = ()
    borders: tuple[Cubic, ...] = ()
    direction: str = "standard"


@dataclass(frozen=True, slots=True)
class LaneSection:
    """A stretch of a road with the same lanes.

    Attributes:
        s: Where it begins on the road [m].
        lanes: All lanes, from the leftmost to the rightmost.
    """

    s: float
    lanes: tuple[LaneRecord, ...]

    def lane(self, number: int) -> LaneRecord | None:
        """The lane of that number, or None."""
        return next((lane for lane in self.lanes if lane.id == number), None)


@dataclass(frozen=True, slots=True)
class RoadLink:
    """What lies before or behind a road.

    Attributes:
        kind: "road" or "junction".
        id: Its id.
        contact: Which end of that road, "start" or "end"; None for a junction.
    """

    kind: str
    id: str
    contact: str | None = None


@dataclass(frozen=True, slots=True)
class SignalRecord:
    """A signal beside a road.

    Attributes:
        id: Unique in the map.
        name: Free text.
        type: Kind of signal; "1000001" is a traffic light.
        s: Where it stands along the road [m].
        t: Where it stands across the road, positive to the left [m].
        orientation: Traffic that it is for: "+" along s, "-" against it, "none" both.
        from_lane: Smallest lane id that it holds for.
        to_lane: Largest lane id that it holds for.
        dynamic: Whether it changes.
        value: Number on the sign; -1 if none, in `unit`.
        unit: Unit of `value`, for example "km/h"; empty if none.
    """

    id: str
    name: str
    type: str
    s: float
    t: float
    orientation: str
    from_lane: int
    to_lane: int
    dynamic: bool = True
    value: float = -1.0
    unit: str = ""


@dataclass(frozen=True, slots=True)
class SignalReference:
    """Lanes of a road that a signal beside another road holds for.

    Attributes:
        id: Id of the signal.
        from_lane: Smallest lane id.
        to_lane: Largest lane id.
        s: Where it holds along this road [m].
        orientation: Traffic that it is for: "+" along s, "-" against it, "none" both.
    """

    id: str
    from_lane: int
    to_lane: int
    s: float = 0.0
    orientation: str = "none"


@dataclass(frozen=True, slots=True)
class ObjectRecord:
    """A thing beside or on a road.

    Attributes:
        id: Unique in its road.
        name: Free text.
        type: "building", "tree", "pole", "barrier", "crosswalk", "parkingSpace" and others.
        s: Where it is along the road [m].
        t: Where it is across the road, positive to the left [m].
        heading: Of its own frame against the road [rad].
        outline: Corners in world frame, (x, y) each, counter-clockwise [m].
        height: Above the ground [m].
    """

    id: str
    name: str
    type: str
    s: float
    t: float
    heading: float
    outline: tuple[tuple[float, float], ...]
    height: float


@dataclass(frozen=True, slots=True)
class Road:
    """A road: a reference line and the lanes on both sides of it.

    Attributes:
        id: Unique in the map.
        name: Free text.
        length: Length of the reference line [m].
        junction: Junction that the road crosses, or None.
        pieces: The reference line.
        lane_offsets: Shift of lane 0 to the left of the reference line.
        sections: Lane sections in order.
        predecessor: What lies before the start.
        successor: What lies behind the end.
        signals: Signals beside the road.
        references: Signals of other roads that hold here.
        objects: Things beside and on the road.
        drives_on_left: Whether traffic keeps to the left.
    """

    id: str
    name: str
    length: float
    junction: str | None
    pieces: tuple[Piece, ...]
    lane_offsets: tuple[Cubic, ...]
    sections: tuple[LaneSection, ...]
    predecessor: RoadLink | None = None
    successor: RoadLink | None = None
    signals: tuple[SignalRecord, ...] = ()
    references: tuple[SignalReference, ...] = ()
    objects: tuple[ObjectRecord, ...] = ()
    drives_on_left: bool = False


@dataclass(frozen=True, slots=True)
class Connection:
    """A way into a junction.

    Attributes:
        id: Unique in the junction.
        incoming: Road that leads in.
        connecting: Road that leads across; in a direct junction the road that follows at once.
        contact: Which end of the connecting road meets the incoming one, "start" or "end".
        lane_links: Pairs of lane ids, on the incoming and on the connecting road.
    """

    id: str
    incoming: str
    connecting: str
    contact: str
    lane_links: tuple[tuple[int, int], ...]


@dataclass(frozen=True, slots=True)
class Junction:
    """Where roads meet.

    Attributes:
        id: Unique in the map.
        name: Free text.
        connections: The ways in.
        controllers: Ids of the signal controllers, in the order in which they take turns.
    """

    id: str
    name: str
    connections: tuple[Connection, ...]
    controllers: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class RoadMap:
    """A whole OpenDRIVE map.

    Attributes:
        name: Name in the header.
        roads: Every road by id.
        junctions: Every junction by id.
        controllers: Ids of the signals of each controller, by its id.
    """

    name: str
    roads: Mapping[str, Road]
    junctions: Mapping[str, Junction] = field(default_factory=dict)
    controllers: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
