"""The road network as OpenDRIVE describes it: plain facts, in the words of the standard.

Reference:
    ASAM OpenDRIVE 1.4. Names follow its elements; `s` runs along the reference line of a road and `t` to its left.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Piece:
    """A stretch of a reference line with constant curvature: a line or an arc.

    Attributes:
        s: Where the piece starts on its road [m].
        x: Start, world frame [m].
        y: Start, world frame [m].
        heading: Direction at the start [rad].
        length: Arc length [m].
        curvature: Positive to the left, 0 for a line [1/m].
    """

    s: float
    x: float
    y: float
    heading: float
    length: float
    curvature: float = 0.0


@dataclass(frozen=True, slots=True)
class Cubic:
    """A cubic polynomial a + b ds + c ds^2 + d ds^3 that holds from `start` to the next one.

    Attributes:
        start: Where it begins [m]; on its road (lane offset) or in its lane section (width).
        a: Value at the start [m].
        b: First order [-].
        c: Second order [1/m].
        d: Third order [1/m^2].
    """

    start: float
    a: float
    b: float = 0.0
    c: float = 0.0
    d: float = 0.0


@dataclass(frozen=True, slots=True)
class RoadMark:
    """The mark along the outer edge of a lane (along the middle for lane 0).

    Attributes:
        type: "none", "broken", "solid", "curb".
        color: "standard", "white", "yellow".
        width: Width of the mark [m].
    """

    type: str = "none"
    color: str = "standard"
    width: float = 0.0


@dataclass(frozen=True, slots=True)
class LaneRecord:
    """One lane of a lane section.

    Attributes:
        id: 0 in the middle, positive to the left, negative to the right.
        type: "driving", "shoulder", "sidewalk", "none".
        widths: Width along the section; empty for lane 0.
        predecessor: Lane id at the start, on what lies before.
        successor: Lane id at the end, on what lies behind.
        mark: Mark along the outer edge.
    """

    id: int
    type: str
    widths: tuple[Cubic, ...] = ()
    predecessor: int | None = None
    successor: int | None = None
    mark: RoadMark = RoadMark()


@dataclass(frozen=True, slots=True)
class LaneSection:
    """A stretch of a road with the same lanes.

    Attributes:
        s: Where it begins on the road [m].
        lanes: All lanes, from the leftmost to the rightmost.
    """

    s: float
    lanes: tuple[LaneRecord, ...]


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
    """Lanes of a connecting road that a signal elsewhere holds for.

    Attributes:
        id: Id of the signal.
        from_lane: Smallest lane id.
        to_lane: Largest lane id.
    """

    id: str
    from_lane: int
    to_lane: int


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


@dataclass(frozen=True, slots=True)
class Connection:
    """A way into a junction.

    Attributes:
        id: Unique in the junction.
        incoming: Road that leads in.
        connecting: Road that leads across.
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
