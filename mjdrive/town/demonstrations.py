"""Routes on which a town is shown to those who learn to drive in it."""

from collections import Counter
from itertools import groupby

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Move, Route, Town
from mjdrive.errors import RouteError
from mjdrive.town import routing
from mjdrive.town.lane_graph import lane_length

_CANDIDATES = 48
"""Routes drawn for each that is kept."""

_EVENNESS = 1.0
"""What it is worth to even out left, straight and right, against driving on new ground alone."""

Waypoints = tuple[tuple[float, float], ...]


def demonstration_routes(
    town: Town, *, num_routes: int, length: float, rng: np.random.Generator
) -> dict[str, Waypoints]:
    """Choose routes that spread over a town and turn left, go straight and turn right about equally often.

    Each is the best of some random routes: most of it on lanes that no route before it drives on, and its moves
    those that were rare so far. Its waypoints give the same lanes again when `routing.route_through` connects them.

    Args:
        town: The town.
        num_routes: How many to choose.
        length: About how long they are; a sixth more or less [m].
        rng: Source of the routes.

    Returns:
        Waypoints on the centre lines of lanes, rounded to 0.1 m, by the names "route0", "route1" and so on [m].

    Raises:
        RouteError: If no way through the town is that long.
    """
    routes: dict[str, Waypoints] = {}
    driven: set[str] = set()
    moves = Counter[Move]()
    for number in range(num_routes):
        candidates = sorted(
            _candidates(town, length, rng),
            key=lambda route: _worth(town, route.lanes, driven, moves),
            reverse=True,
        )
        found = ((route, _waypoints(town, route)) for route in candidates)
        best = next((pair for pair in found if _is_given_again(town, *pair)), None)
        if best is None:
            raise RouteError(
                f"Found no route of about {length:.0f} m in town '{town.name}'. Its lanes end too soon: ask for "
                "shorter routes, or see `mjdrive towns check`."
            )
        route, waypoints = best
        routes[f"route{number}"] = tuple((float(x), float(y)) for x, y in waypoints)
        driven.update(route.lanes)
        moves.update(_moves(town, route.lanes))
    return routes


def _candidates(town: Town, length: float, rng: np.random.Generator) -> list[Route]:
    """Draw random routes from anywhere in the town."""
    found = []
    for _ in range(_CANDIDATES):
        lane, station = routing.random_start(town, rng)
        wanted = length * float(rng.uniform(5 / 6, 7 / 6))
        try:
            found.append(
                routing.random_route(town, lane=lane, station=station, length=wanted, rng=rng)
            )
        except RouteError:
            continue  # every way from there comes to a dead end before the route is long enough
    return found


def _is_given_again(town: Town, route: Route, waypoints: Float[np.ndarray, "K 2"]) -> bool:
    try:
        return routing.route_through(town, waypoints).lanes == route.lanes
    except RouteError:
        return False  # a rounded waypoint lies beside a very narrow lane


def _waypoints(town: Town, route: Route) -> Float[np.ndarray, "K 2"]:
    """Take both ends of a route and the middle of each of its streets."""
    points = []
    for index, group in groupby(range(len(route.points)), key=lambda i: int(route.lane_index[i])):
        inside = list(group)
        if index in (0, len(route.lanes) - 1):
            points.append(route.points[inside[0 if index == 0 else -1]])
        elif town.lanes[route.lanes[index]].junction is None:
            points.append(route.points[inside[len(inside) // 2]])
    return np.round(np.stack(points), 1)


def _worth(town: Town, lanes: tuple[str, ...], driven: set[str], moves: Counter[Move]) -> float:
    """Judge a route: the share of it on lanes not driven so far, and how even it makes the moves, both 0 to 1."""
    lengths = {name: lane_length(town.lanes[name]) for name in set(lanes)}
    new = sum(length for name, length in lengths.items() if name not in driven)
    together = moves + _moves(town, lanes)
    counts = [together[move] for move in (Move.LEFT, Move.STRAIGHT, Move.RIGHT)]
    evenness = min(counts) / max(1, *counts)
    return new / sum(lengths.values()) + _EVENNESS * evenness


def _moves(town: Town, lanes: tuple[str, ...]) -> Counter[Move]:
    return Counter(
        town.lanes[name].move for name in lanes if town.lanes[name].move is not Move.FOLLOW
    )
