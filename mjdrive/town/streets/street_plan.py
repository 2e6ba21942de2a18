"""A town as a compact street plan: nodes, streets, one radius a turn."""

import tomllib
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from mjdrive.config import from_dict, require
from mjdrive.errors import TownFormatError


@dataclass(frozen=True, slots=True)
class CrossSection:
    """Widths of the lanes on each side of a street, from the middle outwards.

    Attributes:
        lane: Driving lane [m].
        shoulder: Gutter between lane and kerb [m].
        sidewalk: Sidewalk behind the kerb [m].
    """

    lane: float = 4.0
    shoulder: float = 0.3
    sidewalk: float = 4.0


@dataclass(frozen=True, slots=True)
class CornerPlan:
    """A bend that joins two streets; it becomes a road with the id of its node.

    Attributes:
        arms: Distance from the node at which each street ends, by road id, in the order of the bend [m].
        radius: Radius of the middle of the street [m].
    """

    arms: dict[str, float]
    radius: float

    def __post_init__(self) -> None:
        require(len(self.arms) == 2, f"A corner has the arms {list(self.arms)}; expected two.")


@dataclass(frozen=True, slots=True)
class TurnPlan:
    """A move through a junction that is not straight.

    Attributes:
        come: Road that it comes from.
        go: Road that it leaves by.
        radius: Radius of the middle of the lane [m].
    """

    come: str
    go: str
    radius: float


@dataclass(frozen=True, slots=True)
class LightPlan:
    """A traffic light.

    Attributes:
        road: Road whose traffic it stops, at the edge of the junction.
        id: Id of the signal.
        pole: Where its pole stands: x, y in the world frame [m]; on the sidewalk beside the stop line if None.
    """

    road: str
    id: str
    pole: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class TurnRadii:
    """Radii of turns that a junction does not list.

    Attributes:
        left: Of the middle of the lane [m].
        right: Of the middle of the lane [m].
    """

    left: float = 10.0
    right: float = 6.0


@dataclass(frozen=True, slots=True)
class JunctionPlan:
    """Where three or more streets meet.

    Attributes:
        arms: Distance from the node at which each street ends and its stop line lies, by road id [m].
        lights: One light a street, in the order in which they turn green; none if traffic just goes.
        turns: Radii of turns; a pair of streets that is not listed is driven straight through where both
            point the same way to 45 degrees, and by the turn radii of the plan otherwise.
    """

    arms: dict[str, float]
    lights: tuple[LightPlan, ...] = ()
    turns: tuple[TurnPlan, ...] = ()


@dataclass(frozen=True, slots=True)
class RoundaboutPlan:
    """A one-way ring, driven counter-clockwise and without lights; its node is the centre.

    Attributes:
        arms: Distance from the node at which each street ends, by road id, counter-clockwise [m].
        radius: Of the middle of the ring lane [m].
        entry_radius: Of the middle of the lanes that lead in and out [m].
    """

    arms: dict[str, float]
    radius: float = 16.0
    entry_radius: float = 12.0

    def __post_init__(self) -> None:
        require(
            len(self.arms) >= 2,
            f"A roundabout has the arms {list(self.arms)}; expected two or more.",
        )


@dataclass(frozen=True, slots=True)
class SpeedSignPlan:
    """A speed limit sign; it is for the traffic on whose side of the street it stands.

    Attributes:
        id: Id of the signal.
        road: Street that it stands beside.
        limit_kmh: Number on the sign [km/h].
        at: Where it stands: x, y in the world frame [m].
    """

    id: str
    road: str
    limit_kmh: float
    at: tuple[float, float]


LARGEST_ID = 999
"""Ids above this are left for the roads that the builder draws across junctions."""


@dataclass(frozen=True, slots=True)
class StreetPlan:
    """Everything that a map is drawn from. Streets run straight from node to node, or bend on the way.

    Ids of roads, corners, junctions and roundabouts are whole numbers from 0 to 999 written as text; each is used once.

    Attributes:
        name: Name of the town.
        nodes: Where streets meet, by the id of the corner, junction or roundabout there: x, y in the world frame [m].
        streets: Ids of the nodes where each street begins and ends, by road id.
        corners: Bends where two streets meet without lights, by node id.
        junctions: Where three or more streets meet, by node id.
        bends: Points where a street changes its direction gently, in order, by road id [m].
        cross_section: Widths, the same everywhere.
        roundabouts: Rings where streets meet, by node id.
        turn_radii: Radii of turns that a junction does not list.
        signs: Speed limit signs.
    """

    name: str
    nodes: dict[str, tuple[float, float]]
    streets: dict[str, tuple[str, str]]
    corners: dict[str, CornerPlan] = field(default_factory=dict)
    junctions: dict[str, JunctionPlan] = field(default_factory=dict)
    bends: dict[str, tuple[tuple[float, float], ...]] = field(default_factory=dict)
    cross_section: CrossSection = CrossSection()
    roundabouts: dict[str, RoundaboutPlan] = field(default_factory=dict)
    turn_radii: TurnRadii = TurnRadii()
    signs: tuple[SpeedSignPlan, ...] = ()

    def __post_init__(self) -> None:
        kinds = (self.corners, self.junctions, self.roundabouts)
        known = {node for kind in kinds for node in kind} & set(self.nodes)
        for road, ends in self.streets.items():
            for node in ends:
                require(
                    node in known,
                    f"Street '{road}' ends at node '{node}'; expected one of {sorted(known)}.",
                )
        uses = Counter([*self.streets, *(node for kind in kinds for node in kind)])
        for name, count in uses.items():
            require(
                count == 1 and name.isdecimal() and int(name) <= LARGEST_ID,
                f"Id '{name}' is used {count} times; expected whole numbers from 0 to {LARGEST_ID}, each used once.",
            )
        lights = [light.id for plan in self.junctions.values() for light in plan.lights]
        for name, count in Counter([*lights, *(sign.id for sign in self.signs)]).items():
            require(count == 1, f"Signal id '{name}' is used {count} times; expected once.")
        for sign in self.signs:
            require(
                sign.road in self.streets,
                f"Sign '{sign.id}' stands beside street '{sign.road}'; expected one of {sorted(self.streets)}.",
            )


def read_plan(path: Path) -> StreetPlan:
    """Read a street plan.

    Args:
        path: TOML file.

    Returns:
        The plan.

    Raises:
        TownFormatError: If the file is missing or no TOML.
        ConfigError: If it does not describe a plan.
    """
    try:
        values = tomllib.loads(path.read_text())
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise TownFormatError(
            f"Cannot read the street plan '{path}': {error}. Expected TOML."
        ) from error
    return from_dict(StreetPlan, values)
