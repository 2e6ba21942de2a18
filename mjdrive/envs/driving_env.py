"""The simulation as a Gymnasium environment."""

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from jaxtyping import Shaped, UInt8

from mjdrive.bev.layers import Layer
from mjdrive.config import BevConfig, EnvConfig, SimulationConfig
from mjdrive.datatypes import Action, Observation
from mjdrive.envs import frames, rewards, window
from mjdrive.envs.world import Outcome, World
from mjdrive.errors import ConfigError, UnknownNameError
from mjdrive.vehicle import cars

FASTEST = 100.0
"""No car here reaches this speed, forwards or backwards [m/s]."""

Seen = dict[str, Any]
"""Observation: "bev" and "state"."""


class DrivingEnv(gymnasium.Env[Seen, np.ndarray]):
    """Drive a car freely through a town, ten decisions a second.

    ## Description

    A car under MuJoCo physics starts at rest on a random lane, at a random time of the light cycle. There is no route:
    every way on is right that keeps the rules. Source of the task: Antonelo, Couto, Möller, "Exploring multimodal
    implicit behavior learning for vehicle navigation in simulated cities".

    ## Action space

    `Box(-1, 1, (2,), float32)`

    | number | meaning | -1 | 1 |
    |---|---|---|---|
    | 0 | acceleration [-] | full brake | full throttle |
    | 1 | steering [-] | full right | full left |

    ## Observation space

    `Dict`, all that a learned policy may see (`mjdrive.datatypes.Observation`)

    | key | space | meaning |
    |---|---|---|
    | bev | `Box(0, 255, (5, 192, 192), uint8)` | bird's-eye view, 5 px/m, car looking up: road, lane lines, lights 1.5 s ago, 0.8 s ago, now |
    | state | `Box(float32, (3,))` | speed [m/s], previous acceleration [-], previous steering [-] |

    ## Reward

    The sum of named terms, weighed by `RewardConfig`: `progress` on lanes that run the car's way, minus `comfort`
    (squared acceleration), minus a cost for each `red_light`, `collision`, `off_road`, `kerb`, `wrong_way` and `stuck`.
    `info["reward_terms"]` holds each of them.

    ## Starting state

    `options={"lane": name, "station": metres}` starts at a place of your own. The same seed gives the same bytes.

    ## End of an episode

    Terminated: an infraction of `EnvConfig.ends_on`, by default a collision or leaving the road.
    Truncated: after `max_episode_steps`, 1200 (120 s) for the registered ids.

    ## Info

    `time` [s], `distance` [m], `score` [m] and `infractions` (so often each, since the start [-]) as in `summary.json` of
    `mjdrive drive`; `new_infractions` names those of this step; `reward_terms` [-].

    ## Rendering

    "rgb_array" gives a picture of 384 px height, "human" shows it in a window. `view="map"` draws the bird's-eye view
    beside the town, without OpenGL; "chase", "hood" and "top" are cameras of the scene, which need it.

    ## Version history

    v0: first.

    Args:
        town: Name of the town.
        car: Name or MJCF file of the car.
        config: Rewards and endings.
        render_mode: "rgb_array", "human" or None.
        view: What `render` shows.

    Raises:
        UnknownNameError: If there is no such town, view or mode.
        RenderError: If this machine cannot show that view.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012  (Gymnasium's name for it)
        "render_modes": ["rgb_array", "human"],
        "render_fps": round(1.0 / SimulationConfig().control_interval),
    }

    def __init__(
        self,
        town: str = "town02",
        *,
        car: str = cars.DEFAULT,
        config: EnvConfig | None = None,
        render_mode: str | None = None,
        view: str = frames.MAP,
    ) -> None:
        _require_known("render mode", render_mode, (None, *self.metadata["render_modes"]))
        _require_known("view", view, (frames.MAP, *frames.CAMERAS))
        if render_mode == "human":
            window.require_display()
        self.render_mode = render_mode
        self.observation_space = observation_space()
        self.action_space = spaces.Box(-1.0, 1.0, (2,), np.float32)
        self._world = World(town, car=car, config=config)
        self._seen: Observation | None = None
        self._frames = None if render_mode is None else _frames(self._world, view)
        self._window: window.Window | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Seen, dict[str, Any]]:
        """Begin a drive.

        Args:
            seed: Starts a new stream of random numbers.
            options: "lane" and "station" of the start.

        Raises:
            ConfigError: If there is another option.
            RouteError: If there is no such place.
        """
        super().reset(seed=seed)
        place = dict(options or {})
        lane, station = place.pop("lane", None), place.pop("station", 0.0)
        if place or (lane is None and "station" in (options or {})):
            raise ConfigError(
                f"Reset options are {options}; expected 'lane', the name of a lane, with or without 'station', a place on it [m]."
            )
        self._world.start(self.np_random, lane=lane, station=float(station))
        if self._frames is not None:
            self._frames.reset()
        return self._look(Outcome(dict.fromkeys(rewards.TERMS, 0.0), (), is_over=False))

    def step(
        self, action: Shaped[np.ndarray, "2"]
    ) -> tuple[Seen, float, bool, bool, dict[str, Any]]:
        """Drive for 0.1 s.

        Args:
            action: Acceleration and steering; values beyond [-1, 1] are clipped [-].

        Raises:
            PhysicsError: If the physics has become unstable.
        """
        acceleration, steering = np.asarray(action, float).tolist()
        outcome = self._world.step(Action(acceleration, steering))
        seen, told = self._look(outcome)
        return seen, outcome.reward, outcome.is_over, False, told

    def render(self) -> UInt8[np.ndarray, "H W 3"] | None:
        """Draw a picture; in the mode "human" it has been shown by then.

        Returns:
            Red, green, blue, top row first, in the mode "rgb_array" [-].
        """
        if self.render_mode != "rgb_array" or self._frames is None or self._seen is None:
            return None
        return self._frames.draw(self._seen)

    def close(self) -> None:
        """Close the window, and give the memory of OpenGL back."""
        if self._window is not None:
            self._window.close()
            self._window = None
        if self._frames is not None:
            self._frames.close()
            self._frames = None

    def _look(self, outcome: Outcome) -> tuple[Seen, dict[str, Any]]:
        simulation, tally = self._world.simulation, self._world.tally
        self._seen = simulation.observe()
        if self._frames is not None:
            self._frames.follow(simulation.vehicle)
            if self.render_mode == "human":
                self._show(self._frames.draw(self._seen))
        counts = {name: tally.counts[kind] for kind, name in rewards.INFRACTION_TERMS.items()}
        told = {
            "time": simulation.time,
            "distance": tally.distance,
            "score": tally.score,
            "infractions": counts,
            "new_infractions": tuple(
                rewards.INFRACTION_TERMS[infraction.kind] for infraction in outcome.infractions
            ),
            "reward_terms": dict(outcome.terms),
        }
        # Learners expect arrays that are theirs; those of an Observation are nobody's to change.
        return {"bev": self._seen.bev.copy(), "state": self._seen.state.copy()}, told

    def _show(self, picture: UInt8[np.ndarray, "H W 3"]) -> None:
        if self._window is None:
            height, width, _ = picture.shape
            self._window = window.Window(
                f"mjdrive {self._world.simulation.town.name}",
                width=width,
                height=height,
                interval=self._world.simulation.config.control_interval,
            )
        self._window.show(picture)


def observation_space() -> spaces.Dict:
    """What an `Observation` can be."""
    size = BevConfig().size_px
    limits = np.array([FASTEST, 1.0, 1.0], np.float32)
    return spaces.Dict(
        {
            "bev": spaces.Box(0, 255, (len(Layer), size, size), np.uint8),
            "state": spaces.Box(-limits, limits, dtype=np.float32),
        }
    )


def _frames(world: World, view: str) -> frames.MapFrames | frames.CameraFrames:
    if view == frames.MAP:
        return frames.MapFrames(world.simulation)
    return frames.CameraFrames(world.simulation, view)


def _require_known(kind: str, name: str | None, known: tuple[str | None, ...]) -> None:
    if name not in known:
        raise UnknownNameError(kind, str(name), [one for one in known if one is not None])
