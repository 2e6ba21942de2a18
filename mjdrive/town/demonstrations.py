"""Routes on which a town is shown to those who learn to drive in it."""

from collections import Counter
from collections.abc import Sequence
from itertools import groupby

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Move, Route, Town
from mjdrive.errors import RouteError
from mjdrive.town import routing
from mjdrive.town.lane_graph import lane_length
from mjdrive.town.route_line import Chain, lay

_CANDIDATES = 48
"""Routes drawn for each that is kept."""

_EVENNESS = 1.0
"""What it is worth to even out left, straight and right, against driving on new ground alone."""

_SHORTER = (400.0, 200.0)
"""Lengths to fall back on where a town ends before a longer route does [m]."""

_MIDDLE = (1 / 2,)
"""Where on a street its waypoints lie, as shares of it, so that a route is given again almost always [-]."""

_THIRDS = (1 / 3, 2 / 3)
"""The same where a route drives round on the same street, which the middles alone do not tell [-]."""

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
        length: About how long they are; a sixth more or less. Where no way is that long, all are of about 400 m or
            200 m [m].
        rng: Source of the routes.

    Returns:
        Waypoints on the centre lines of lanes, rounded to 0.1 m, by the names "route0", "route1" and so on [m].

    Raises:
        RouteError: If no way through the town is long enough for any of these.
    """
    for wanted in (length, *(shorter for shorter in _SHORTER if shorter < length)):
        routes = _routes(town, num_routes, wanted, rng)
        if len(routes) == num_routes:
            return routes
    shorter = f", nor one of {wanted:.0f} m" if wanted < length else ""
    raise RouteError(
        f"Found no route of about {length:.0f} m in town '{town.name}'{shorter}. Its lanes end too soon: see "
        "`mjdrive towns check`."
    )


def _routes(
    town: Town, num_routes: int, length: float, rng: np.random.Generator
) -> dict[str, Waypoints]:
    """Choose routes, fewer where the next cannot be had."""
    routes: dict[str, Waypoints] = {}
    driven: set[str] = set()
    moves = Counter[Move]()
    for number in range(num_routes):
        candidates = sorted(
            _candidates(town, length, rng),
            key=lambda chain: _worth(town, chain.lanes, driven, moves),
            reverse=True,
        )
        best = _first_given_again(town, candidates)
        if best is None:
            break
        route, waypoints = best
        routes[f"route{number}"] = tuple((float(x), float(y)) for x, y in waypoints)
        driven.update(route.lanes)
        moves.update(_moves(town, route.lanes))
    return routes


def _candidates(town: Town, length: float, rng: np.random.Generator) -> list[Chain]:
    """Draw random routes from anywhere in the town."""
    found = []
    for _ in range(_CANDIDATES):
        lane, station = routing.random_start(town, rng, length=length * 7 / 6)
        wanted = length * float(rng.uniform(5 / 6, 7 / 6))
        try:
            found.append(
                routing.random_chain(town, lane=lane, station=station, length=wanted, rng=rng)
            )
        except RouteError:
            continue  # every way from there comes to a dead end before the route is long enough
    return found


def _first_given_again(
    town: Town, candidates: Sequence[Chain]
) -> tuple[Route, Float[np.ndarray, "K 2"]] | None:
    """Find the first route that waypoints give again, with few waypoints if any can, and these waypoints."""
    for shares in (_MIDDLE, _THIRDS):
        for lanes, start, end in candidates:
            route = lay(town, lanes, start=start, end=end)
            waypoints = _waypoints(town, route, shares)
            if _is_given_again(town, route, waypoints):
                return route, waypoints
    return None


def _is_given_again(town: Town, route: Route, waypoints: Float[np.ndarray, "K 2"]) -> bool:
    try:
        return routing.route_through(town, waypoints).lanes == route.lanes
    except RouteError:
        return False  # a rounded waypoint lies beside a very narrow lane


def _waypoints(town: Town, route: Route, shares: tuple[float, ...]) -> Float[np.ndarray, "K 2"]:
    """Take both ends of a route and some points of each of its streets.

    The first and the last street have their end alone, unless streets have several points.
    """
    points = []
    last = len(route.lanes) - 1
    for index, group in groupby(range(len(route.points)), key=lambda i: int(route.lane_index[i])):
        inside = list(group)
        is_end, is_street = index in (0, last), town.lanes[route.lanes[index]].junction is None
        if index == 0:
            points.append(route.points[inside[0]])
        if is_street and (len(shares) > 1 or not is_end):
            points += [route.points[inside[int(share * len(inside))]] for share in shares]
        if index == last:
            points.append(route.points[inside[-1]])
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
