"""What town.json says about a town beside its map."""

from dataclasses import dataclass, field

from mjdrive.config import require


@dataclass(frozen=True, slots=True)
class LightTiming:
    """How long a traffic light shows each signal; the approaches of a junction take turns.

    Attributes:
        green: Green in a turn [s].
        yellow: Yellow after it [s].
        all_red: Red for every approach before the next turn [s].
    """

    green: float = 10.0
    yellow: float = 3.0
    all_red: float = 2.0

    def __post_init__(self) -> None:
        for name in ("green", "yellow", "all_red"):
            value = getattr(self, name)
            require(value >= 0.0, f"{name} is {value} s; expected 0 or more.")
        require(
            self.turn > 0.0, "green, yellow and all_red are all 0 s; expected a turn that lasts."
        )

    @property
    def turn(self) -> float:
        """Time from the green of one approach to the green of the next [s]."""
        return self.green + self.yellow + self.all_red


@dataclass(frozen=True, slots=True)
class SceneryConfig:
    """What the scene generator builds beside the roads.

    Attributes:
        seed: Seed of houses and trees [-].
        sidewalk_width: From the kerb to the far edge of the sidewalk, the verge included [m].
        verge_width: Grass between kerbstone and sidewalk, away from junctions; 0 for none [m].
        building_setback: Distance from the sidewalk to the houses [m].
        building_width: Shortest and longest front of a house [m].
        building_depth: Least and largest depth of a house [m].
        building_height: Lowest and highest house [m].
        building_gap: Smallest and largest gap between neighbours [m].
        pole_height: Height of a light pole [m].
        tree_spacing: Mean distance between two trees along a verge; 0 for no trees [m].
        tree_height: Lowest and highest tree [m].
        garden_tree_spacing: Mean distance between trees behind the houses, in blocks that roads enclose; 0 for none [m].
    """

    seed: int = 0
    sidewalk_width: float = 4.0
    verge_width: float = 1.2
    building_setback: float = 2.0
    building_width: tuple[float, float] = (8.0, 22.0)
    building_depth: tuple[float, float] = (8.0, 14.0)
    building_height: tuple[float, float] = (5.0, 18.0)
    building_gap: tuple[float, float] = (2.0, 10.0)
    pole_height: float = 4.5
    tree_spacing: float = 24.0
    tree_height: tuple[float, float] = (5.0, 8.0)
    garden_tree_spacing: float = 40.0

    def __post_init__(self) -> None:
        for name in (
            "building_width",
            "building_depth",
            "building_height",
            "building_gap",
            "tree_height",
        ):
            low, high = getattr(self, name)
            require(
                0.0 < low <= high, f"{name} is {low} to {high} m; expected 0 < least <= largest."
            )
        for name in ("verge_width", "tree_spacing", "building_setback", "garden_tree_spacing"):
            value = getattr(self, name)
            require(value >= 0.0, f"{name} is {value} m; expected 0 or more.")
        require(
            self.verge_width + 1.0 <= self.sidewalk_width,
            f"sidewalk_width is {self.sidewalk_width} m; expected at least 1 m more than "
            f"verge_width, which is {self.verge_width} m.",
        )


@dataclass(frozen=True, slots=True)
class TownSettings:
    """What town.json holds.

    Attributes:
        description: One sentence for lists of towns.
        lights: Light timing of every junction.
        routes: Waypoints (x, y) by route name, world frame [m].
        scenery: What stands beside the roads.
        origin: Point of the map that is the origin of the town, x and y [m].
        flatten: Whether heights and banks of the map are left out; a map that has some is refused otherwise.
    """

    description: str = ""
    lights: LightTiming = field(default_factory=LightTiming)
    routes: dict[str, tuple[tuple[float, float], ...]] = field(default_factory=dict)
    scenery: SceneryConfig = field(default_factory=SceneryConfig)
    origin: tuple[float, float] = (0.0, 0.0)
    flatten: bool = False

    def __post_init__(self) -> None:
        for name, waypoints in self.routes.items():
            require(
                len(waypoints) >= 2,
                f"Route '{name}' has {len(waypoints)} waypoints; expected two or more.",
            )
