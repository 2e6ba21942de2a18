"""The names under which Gymnasium makes our environments.

Reading the maps takes a while, so nothing is loaded before an environment is made.
"""

import gymnasium

TOWNS = ("town01", "town02", "town03")
"""The towns that come with mjdrive; each has an id."""

ANY_TOWN = "mjdrive/Drive-v0"
"""Id for towns of your own: `gymnasium.make(ANY_TOWN, town="mine")`."""

TIME_LIMIT = 1200
"""Control steps until an episode is truncated: 120 s [-]."""

_MAKER = "mjdrive.envs.driving_env:DrivingEnv"


def id_of(town: str) -> str:
    """Id of a shipped town, as "mjdrive/Town02-v0"."""
    return f"mjdrive/{town.capitalize()}-v0"


def register() -> None:
    """Tell Gymnasium of our environments, once."""
    for town in TOWNS:
        _register(id_of(town), town=town)
    _register(ANY_TOWN)


def _register(name: str, **settings: str) -> None:
    if name not in gymnasium.registry:
        gymnasium.register(name, _MAKER, max_episode_steps=TIME_LIMIT, kwargs=settings)
