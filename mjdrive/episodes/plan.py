"""Which episodes a collection consists of: what each drives, under which name and with which seed."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mjdrive.config import CollectConfig
from mjdrive.datatypes import Route, Town
from mjdrive.errors import ConfigError, RouteError, UnknownNameError
from mjdrive.town.routing import route_through

WALK_LENGTH = 1000.0
"""A random walk is cut into episodes of this length, unless their number is given [m]."""

SHORTEST_WALK = 50.0
"""An episode of a random walk is no shorter [m]."""


@dataclass(frozen=True, slots=True)
class PlannedEpisode:
    """One episode that is to be driven.

    Attributes:
        name: Unique in its data set.
        seed: Decides all that is random in it.
        route: Name of the route to drive; empty for a random walk.
        length: How far it leads [m].
    """

    name: str
    seed: int
    route: str
    length: float


def lay_routes(
    town: Town,
    waypoints: Mapping[str, Sequence[tuple[float, float]]],
    *,
    settings: CollectConfig,
) -> dict[str, Route]:
    """Lay the routes that a collection drives.

    Args:
        town: Where they lie.
        waypoints: Places on the lanes by the names of all routes [m].
        settings: Which of them are driven.

    Raises:
        RouteError: If waypoints do not lie on lanes, or no lanes connect them; it names the route.
        UnknownNameError: If a route is not one of the town's.
    """
    if settings.random_walk_km:
        return {}
    routes = {}
    for name in settings.routes or waypoints:
        if name not in waypoints:
            raise UnknownNameError(f"route of {town.name}", name, waypoints)
        try:
            routes[name] = route_through(town, np.array(waypoints[name]))
        except RouteError as error:
            raise RouteError(f"Route '{name}' of {town.name} cannot be driven. {error}") from error
    return routes


def plan(
    town: Town, routes: Mapping[str, Route], *, settings: CollectConfig, seed: int
) -> tuple[PlannedEpisode, ...]:
    """List the episodes of a collection in the order of driving.

    Args:
        town: Where they are driven.
        routes: Its routes by name.
        settings: Which routes and how often, or how far at random.
        seed: The same seed gives the same plan.

    Raises:
        ConfigError: If a random walk would be cut into pieces that are too short.
        RouteError: If the town has no routes.
        UnknownNameError: If a route is not one of the town's.
    """
    if settings.random_walk_km:
        return _walks(settings, seed)
    if not routes:
        raise RouteError(
            f"Town '{town.name}' has no routes. Expected routes in its town.json (town01 has ten); "
            f"without them, `--random-walk KM` drives with random turns."
        )
    names = settings.routes or tuple(routes)
    for name in names:
        if name not in routes:
            raise UnknownNameError(f"route of {town.name}", name, routes)
    count = settings.episodes or len(names) * settings.repeats
    turns = [divmod(index, len(names)) for index in range(count)]
    return tuple(
        PlannedEpisode(
            name=f"{names[place]}-{repeat}",
            seed=episode_seed(seed, index),
            route=names[place],
            length=float(routes[names[place]].station[-1]),
        )
        for index, (repeat, place) in enumerate(turns)
    )


def episode_seed(seed: int, index: int) -> int:
    """Seed of one episode of a collection, unlike those of all others and of neighbouring collections."""
    return int(np.random.SeedSequence([seed, index]).generate_state(1)[0])


def _walks(settings: CollectConfig, seed: int) -> tuple[PlannedEpisode, ...]:
    """Cut a random walk into episodes of 1 km, the last of what is left, or into as many as were asked for."""
    whole = 1000.0 * settings.random_walk_km
    if settings.episodes:
        lengths = [whole / settings.episodes] * settings.episodes
    else:
        lengths = [WALK_LENGTH] * math.floor(whole / WALK_LENGTH)
        rest = whole - sum(lengths)
        if rest >= SHORTEST_WALK or not lengths:
            lengths.append(rest)
        else:
            lengths[-1] += rest
    if min(lengths) < SHORTEST_WALK:
        raise ConfigError(
            f"A random walk of {settings.random_walk_km:g} km in {len(lengths)} episodes makes {min(lengths):.1f} m each; "
            f"expected {SHORTEST_WALK:.0f} m or more. Drive farther, or in fewer episodes."
        )
    return tuple(
        PlannedEpisode(
            name=f"walk-{index}", seed=episode_seed(seed, index), route="", length=length
        )
        for index, length in enumerate(lengths)
    )
