"""Named settings of `collect`."""

import dataclasses
import math
import re
from collections.abc import Iterable
from typing import NamedTuple

from mjdrive.config import CollectConfig, DisturbanceConfig, require
from mjdrive.config.mpc import LatePlan
from mjdrive.errors import UnknownNameError
from mjdrive.expert import experts

_THROTTLE_RATE_PER_MIN = 15.0
"""How often the paper's code pushes the throttle [1/min]."""


def collect_preset(name: str) -> CollectConfig:
    """Settings of `collect` by name: "standard", "quick" (three routes) or "paper" (no disturbance).

    Raises:
        UnknownNameError: If there is no preset of that name.
    """
    presets = {
        "standard": CollectConfig(),
        "quick": CollectConfig(routes=("route0", "route1", "route4")),
        "paper": CollectConfig(disturbance=None),
    }
    if name not in presets:
        raise UnknownNameError("collect preset", name, presets)
    return presets[name]


def chosen(
    preset: str,
    *,
    routes: tuple[str, ...] | None = None,
    random_walk_km: float | None = None,
    episodes: int | None = None,
    expert: str = "pid",
    noise: float | None = None,
    throttle_noise: float | None = None,
) -> CollectConfig:
    """Change a preset; what is None stays as it is there.

    Args:
        preset: Name of the preset.
        routes: Names of the routes to drive.
        random_walk_km: How far to drive with random turns, instead of along routes [km].
        episodes: How many episodes to drive [-].
        expert: Who drives, one of `experts.NAMES`.
        noise: See `with_noise` [-].
        throttle_noise: See `with_throttle_noise` [-].

    Raises:
        ConfigError: If a value is out of its range, or two exclude each other.
        UnknownNameError: If there is no such preset or expert.
    """
    config = collect_preset(preset)
    config = dataclasses.replace(config, expert=experts.known(expert), episodes=episodes)
    if random_walk_km is not None:
        require(
            0 < random_walk_km < math.inf,
            f"random walk is {random_walk_km:g} km; expected more than 0 km, and an end.",
        )
        require(
            routes is None, "A random walk follows no routes; expected one of both to be given."
        )
        config = dataclasses.replace(config, routes=(), random_walk_km=random_walk_km)
    if routes is not None:
        config = dataclasses.replace(config, routes=routes)
    if noise is not None:
        config = with_noise(config, noise)
    return config if throttle_noise is None else with_throttle_noise(config, throttle_noise)


class SolverChoice(NamedTuple):
    """What is said of who solves for the MPC expert; what is None stays as it is.

    Attributes:
        solver: Name of a solver, one of `mjdrive.expert.mpc_solver.SOLVERS`.
        fallback_solver: The one to take where casadi lacks the first.
        late_plan: What is driven when a plan came late, "plan" or "pid".
    """

    solver: str | None = None
    fallback_solver: str | None = None
    late_plan: LatePlan | None = None

    @property
    def options(self) -> str:
        """What is said, as options of a command; empty if nothing is."""
        said = {name: value for name, value in self._asdict().items() if value is not None}
        return " ".join(f"--{name.replace('_', '-')} {value}" for name, value in said.items())


def with_solver(config: CollectConfig, choice: SolverChoice) -> CollectConfig:
    """Choose who solves for the MPC expert, and what a late plan means.

    Args:
        config: Settings to change.
        choice: What is said of it.

    Raises:
        ConfigError: If another expert drives.
    """
    if not choice.options:
        return config
    require(
        config.expert == "mpc",
        f"{choice.options} has no effect on the expert {config.expert}, which solves nothing. "
        f"Expected the expert mpc; choose that, or leave it out.",
    )
    said = {name: value for name, value in choice._asdict().items() if value is not None}
    return dataclasses.replace(config, mpc=dataclasses.replace(config.mpc, **said))


def route_names(text: str, known: Iterable[str]) -> tuple[str, ...]:
    """Read which routes are meant: names, numbers in the order of the town, and ranges of numbers, as in "0-3,loop".

    Args:
        text: Any of these, between commas.
        known: Names of the routes of the town, in their order.

    Raises:
        ConfigError: If a number has no route, or a route is named twice.
        UnknownNameError: If there is no route of a name.
    """
    names = list(known)
    found: list[str] = []
    for part in (part.strip() for part in text.split(",")):
        numbers = re.fullmatch(r"(\d+)(?:-(\d+))?", part)
        if part in names:
            found.append(part)
        elif numbers is None:
            raise UnknownNameError("route", part, names)
        else:
            first, last = int(numbers[1]), int(numbers[2] or numbers[1])
            require(
                first <= last < len(names),
                f"There are no routes '{part}'; expected numbers from 0 to {len(names) - 1}, the smaller first.",
            )
            found += names[first : last + 1]
    require(len(set(found)) == len(found), f"Routes '{text}' name one twice; expected each once.")
    return tuple(found)


def with_noise(config: CollectConfig, scale: float) -> CollectConfig:
    """Change how much a collection is disturbed.

    Args:
        config: Settings to change.
        scale: Factor on the standard amplitude of steering pulses and rate of stops; 0 disturbs nothing [-].

    Returns:
        The changed settings.

    Raises:
        ConfigError: If the scale is negative or makes pulses larger than full lock.
    """
    require(
        0 <= scale <= 2, f"noise is {scale:g}; expected 0 (none) to 2 (pulses up to full lock)."
    )
    if scale == 0:
        return dataclasses.replace(config, disturbance=None)
    standard = DisturbanceConfig()
    disturbance = dataclasses.replace(
        standard,
        steering_amplitude=scale * standard.steering_amplitude,
        stop_rate_per_min=scale * standard.stop_rate_per_min,
    )
    return dataclasses.replace(config, disturbance=disturbance)


def with_throttle_noise(config: CollectConfig, scale: float) -> CollectConfig:
    """Add pulses on the acceleration command, 15 a minute as in the paper's code.

    Args:
        config: Settings to change; other disturbances stay as they are.
        scale: Factor on the standard amplitude; 0 adds none [-].

    Raises:
        ConfigError: If the scale is negative or makes pulses larger than full throttle.
    """
    require(
        0 <= scale <= 2,
        f"throttle noise is {scale:g}; expected 0 (none) to 2 (up to full throttle).",
    )
    if scale == 0:
        return config
    others = config.disturbance or DisturbanceConfig(
        steering_rate_per_min=0.0, stop_rate_per_min=0.0
    )
    disturbance = dataclasses.replace(
        others,
        throttle_rate_per_min=_THROTTLE_RATE_PER_MIN,
        throttle_amplitude=scale * others.throttle_amplitude,
    )
    return dataclasses.replace(config, disturbance=disturbance)
