"""A town as a compact street plan: nodes, straight streets, one radius a turn."""

import tomllib
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
        pole: Where its pole stands: x, y in the world frame [m].
    """

    road: str
    id: str
    pole: tuple[float, float]


@dataclass(frozen=True, slots=True)
class JunctionPlan:
    """Where three or more streets meet.

    Attributes:
        arms: Distance from the node at which each street ends and its stop line lies, by road id [m].
        lights: One light a street, in the order in which they turn green.
        turns: Radii of the turns; a pair of streets that is not listed is driven straight through.
    """

    arms: dict[str, float]
    lights: tuple[LightPlan, ...]
    turns: tuple[TurnPlan, ...]


@dataclass(frozen=True, slots=True)
class StreetPlan:
    """Everything that a map is drawn from. Streets run straight from node to node, or bend slightly on the way.

    Ids of roads, corners and junctions are whole numbers written as text; each is used once.

    Attributes:
        name: Name of the town.
        nodes: Where streets meet, by the id of the corner or junction there: x, y in the world frame [m].
        streets: Ids of the nodes where each street begins and ends, by road id.
        corners: Bends where two streets meet without lights, by node id.
        junctions: T-junctions with lights, by node id.
        bends: Points where a street changes its direction by a little, in order, by road id [m].
        cross_section: Widths, the same everywhere.
    """

    name: str
    nodes: dict[str, tuple[float, float]]
    streets: dict[str, tuple[str, str]]
    corners: dict[str, CornerPlan]
    junctions: dict[str, JunctionPlan]
    bends: dict[str, tuple[tuple[float, float], ...]] = field(default_factory=dict)
    cross_section: CrossSection = CrossSection()

    def __post_init__(self) -> None:
        known = set(self.corners) | set(self.junctions)
        for road, ends in self.streets.items():
            for node in ends:
                require(
                    node in known and node in self.nodes,
                    f"Street '{road}' ends at node '{node}'; expected one of {sorted(known & set(self.nodes))}.",
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
