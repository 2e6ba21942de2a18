"""Towns out of a seed: irregular blocks, T- and X-junctions with lights, corners and gentle bends."""

from itertools import pairwise, permutations

import numpy as np
from jaxtyping import Float
from numpy.random import Generator

from mjdrive.config import require
from mjdrive.town.streets.street_grid import (
    LEAST_JUNCTION,
    Chain,
    GridSize,
    Node,
    StreetGrid,
    thin_out,
)
from mjdrive.town.streets.street_plan import (
    CornerPlan,
    CrossSection,
    JunctionPlan,
    LightPlan,
    StreetPlan,
    TurnPlan,
)

Point = Float[np.ndarray, "2"]
"""A point or a vector of the plane [m]."""

MOST_JUNCTIONS = 100
"""Largest town: ids of streets and nodes have three digits."""

_SPACING = (60.0, 160.0)
"""Least and largest distance between neighbouring lines of the grid [m]."""

_NODE_SHIFT = 4.0
"""How far a crossing may lie from its place on the grid, each way [m]."""

_CORNER_ABOVE = np.pi / 6
"""A street that turns by more at a crossing has a corner there, otherwise a gentle bend [rad]."""

_CORNER_RADIUS = (8.5, 14.0)
_LEFT_RADIUS = (8.0, 12.0)
_RIGHT_RADIUS = (4.5, 8.0)
_ARM = (11.0, 13.5)
"""Ranges of radii and of the distance of stop lines from the node [m]."""

_CURVED_SHARE = 0.4
_CURVED_LENGTH = 80.0
_SAGITTA = (0.02, 0.05)
"""Share of the straight streets longer than this [m] that are curved, and by how much of their length [-]."""

_CORNER_LEAD = 0.5
"""Straight stretch between the end of a street and the arc of a corner [m]."""

_FIT = 0.95
"""Share of the largest radius that fits a junction."""


def generate_plan(*, name: str, num_junctions: int, seed: int) -> StreetPlan:
    """Lay out a town.

    Every junction has three or four streets and a light for each; every lane can be reached from every other.

    Args:
        name: Name of the town.
        num_junctions: Number of junctions, exactly [-].
        seed: Seed; the same gives the same plan [-].

    Returns:
        The street plan.

    Raises:
        ConfigError: If there is no such town.
    """
    require(
        1 <= num_junctions <= MOST_JUNCTIONS,
        f"num_junctions is {num_junctions}; expected 1 to {MOST_JUNCTIONS}.",
    )
    require(seed >= 0, f"seed is {seed}; expected 0 or more.")
    rng = np.random.default_rng([num_junctions, seed])
    sizes = _sizes(num_junctions)
    grid = None
    while grid is None:
        size = sizes[int(rng.integers(len(sizes)))]
        grid = thin_out(size, num_junctions=num_junctions, rng=rng)
    return _lay_out(name, grid, _places(size, rng), rng)


def _sizes(num_junctions: int) -> list[GridSize]:
    """Grids with some more junctions than wanted, not much longer than wide."""
    longest = int(np.sqrt(2 * num_junctions)) + 4
    return [
        size
        for rows in range(3, longest)
        for columns in range(rows, min(rows + 3, longest))
        if num_junctions <= (size := GridSize(columns, rows)).num_junctions
        and size.num_junctions <= max(1.6 * num_junctions + 3.0, 5.0)
    ]


def _places(size: GridSize, rng: Generator) -> dict[Node, Point]:
    """Where each crossing of the grid lies [m]."""
    x, y = (np.cumsum([0.0, *rng.uniform(*_SPACING, size=count - 1)]) for count in size)
    shift = rng.uniform(-_NODE_SHIFT, _NODE_SHIFT, size=(size.columns, size.rows, 2))
    return {
        (column, row): np.round(np.array([x[column], y[row]]) + shift[column, row], 2)
        for column in range(size.columns)
        for row in range(size.rows)
    }


def _lay_out(name: str, grid: StreetGrid, places: dict[Node, Point], rng: Generator) -> StreetPlan:
    """Number streets and nodes, draw bends, radii and lights, and write the plan down."""
    legs = [leg for chain in grid.chains() for leg in _legs(chain, places)]
    streets = {str(index): leg for index, leg in enumerate(legs, start=1)}
    lines = {road: _line(leg, places, rng) for road, leg in streets.items()}
    ends = dict.fromkeys(end for leg in legs for end in (leg[0], leg[-1]))
    names = {node: str(index) for index, node in enumerate(ends, start=len(legs) + 1)}
    away: dict[Node, dict[str, Point]] = {node: {} for node in ends}
    for road, leg in streets.items():
        line = lines[road]
        away[leg[0]][road] = _unit(line[1] - line[0])
        away[leg[-1]][road] = _unit(line[-2] - line[-1])
    junctions, corners = {}, {}
    num_lights = 0
    for node, number in names.items():
        if grid.degree(node) >= LEAST_JUNCTION:
            junctions[number] = _junction(away[node], first_light=num_lights + 1, rng=rng)
            num_lights += grid.degree(node)
        else:
            corners[number] = _corner(away[node], rng)
    return StreetPlan(
        name=name,
        nodes={number: _pair(places[node]) for node, number in names.items()},
        streets={road: (names[leg[0]], names[leg[-1]]) for road, leg in streets.items()},
        corners=corners,
        junctions=junctions,
        bends={
            road: tuple(_pair(point) for point in line[1:-1])
            for road, line in lines.items()
            if line[1:-1]
        },
    )


def _legs(chain: Chain, places: dict[Node, Point]) -> list[Chain]:
    """Cut a chain at its corners."""
    cuts = [0, len(chain) - 1]
    for index in range(1, len(chain) - 1):
        before, here, behind = (places[node] for node in chain[index - 1 : index + 2])
        if abs(_turn(here - before, behind - here)) > _CORNER_ABOVE:
            cuts.insert(-1, index)
    return [chain[start : end + 1] for start, end in pairwise(cuts)]


def _line(leg: Chain, places: dict[Node, Point], rng: Generator) -> list[Point]:
    """Points that a street leads through: a long one between neighbours may be curved."""
    line = [places[node] for node in leg]
    along = line[-1] - line[0]
    if not line[1:-1] and np.hypot(*along) > _CURVED_LENGTH:
        share = rng.choice([-1.0, 1.0]) * rng.uniform(*_SAGITTA)
        if rng.random() < _CURVED_SHARE:
            aside = share * np.array([-along[1], along[0]])
            line.insert(1, np.round(0.5 * (line[0] + line[-1]) + aside, 2))
    return line


def _junction(away: dict[str, Point], *, first_light: int, rng: Generator) -> JunctionPlan:
    arms = {road: _draw(_ARM, rng) for road in away}
    turns = []
    for come, go in permutations(away, 2):
        turn = _turn(-away[come], away[go])
        if abs(turn) > _CORNER_ABOVE:
            half_lane = 0.5 * CrossSection().lane
            # The middles of the lanes meet beyond the node for left turns, before it for right turns.
            half_tangent = np.tan(0.5 * abs(turn))
            largest = min(arms[come], arms[go]) / half_tangent + np.copysign(half_lane, turn)
            drawn = _draw(_LEFT_RADIUS if turn > 0.0 else _RIGHT_RADIUS, rng)
            turns.append(TurnPlan(come, go, min(drawn, round(_FIT * float(largest), 2))))
    lights = [LightPlan(road, str(index)) for index, road in enumerate(away, start=first_light)]
    return JunctionPlan(arms, tuple(lights), tuple(turns))


def _corner(away: dict[str, Point], rng: Generator) -> CornerPlan:
    radius = _draw(_CORNER_RADIUS, rng)
    come, go = away.values()
    reach = round(radius * float(np.tan(0.5 * abs(_turn(-come, go)))) + _CORNER_LEAD, 2)
    return CornerPlan(dict.fromkeys(away, reach), radius)


def _draw(span: tuple[float, float], rng: Generator) -> float:
    return round(float(rng.uniform(*span)), 2)


def _pair(point: Point) -> tuple[float, float]:
    return float(point[0]), float(point[1])


def _unit(vector: Point) -> Point:
    unit: Point = vector / np.hypot(*vector)
    return unit


def _turn(first: Point, second: Point) -> float:
    """Angle from one direction to another, positive to the left [rad]."""
    cross = first[0] * second[1] - first[1] * second[0]
    return float(np.arctan2(cross, first @ second))
