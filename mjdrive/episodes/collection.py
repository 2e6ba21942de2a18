"""Demonstrations: an expert drives the routes of a town."""

from collections.abc import Callable

import numpy as np

from mjdrive.config import CollectConfig
from mjdrive.datatypes import Episode, Route
from mjdrive.episodes.disturbance import Disturbance
from mjdrive.episodes.rollout import rollout
from mjdrive.episodes.views import FollowRoute
from mjdrive.errors import RouteError
from mjdrive.expert.pid import PidExpert
from mjdrive.simulation.simulation import Simulation


def collect_route(
    simulation: Simulation,
    route: Route,
    *,
    config: CollectConfig,
    seed: int,
    on_step: Callable[[int], None] | None = None,
) -> Episode:
    """Let the PID expert drive one route from its start to its end.

    Args:
        simulation: World to drive in; it is reset.
        route: Path to follow, starting on the centre of its first lane.
        config: Expert and disturbance.
        seed: Decides lights and disturbances.
        on_step: Told the number of control steps done.

    Returns:
        The demonstration; its labels are the expert's clean actions.

    Raises:
        RouteError: If the expert does not reach the end in time.
    """
    follow = FollowRoute(route)
    x, y = route.points[0]
    simulation.place(x=float(x), y=float(y), yaw=float(route.yaw[0]), seed=seed)
    interval = simulation.config.control_interval
    rng = np.random.default_rng([seed, 1])
    disturbance = None
    if config.disturbance is not None:
        disturbance = Disturbance(config.disturbance, rng, interval=interval)
    episode = rollout(
        simulation,
        PidExpert(
            simulation.town,
            parameters=simulation.car.parameters,
            config=config.pid,
            control_interval=interval,
        ),
        follow,
        num_steps=int(config.step_limit_per_metre * route.station[-1]),
        seed=seed,
        disturbance=disturbance,
        stop=lambda: follow.is_finished,
        on_step=on_step,
    )
    if not follow.is_finished:
        raise RouteError(
            f"The expert got {follow.station:.0f} m along a route of {route.station[-1]:.0f} m "
            f"in {len(episode.time)} steps. Expected it to arrive; try less disturbance."
        )
    return episode
