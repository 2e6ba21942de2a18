"""Policies that a page can watch: what each decides, and what it thought of the alternatives."""

from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
import torch
from jaxtyping import Float, Int8, UInt8
from torch.nn import functional as F  # noqa: N812

from mjdrive.config import CollectConfig, PidConfig
from mjdrive.datatypes import Action, Observation, Policy
from mjdrive.episodes.collection import expert_of
from mjdrive.episodes.views import FollowWalk
from mjdrive.expert import experts
from mjdrive.learning.pilot import Pilot
from mjdrive.simulation.simulation import Simulation
from mjdrive.study.jobs.landscapes import action_grid
from mjdrive.town import routing
from mjdrive.town.random_walk import RandomWalk
from models.ibc import IbcLearner

POINTS = 64
"""Grid points of the landscape along each action component, at most [-]."""

DEPTH = 12.0
"""Log densities this far below the highest look alike [nats]."""

MOST_CANDIDATES = 192
"""Of each iteration of a sampler that are shown [-]."""

STEPS_LIKE_DRIVE = 3000
"""Control steps of `mjdrive drive`, so that the same seed starts at the same place here [-]."""


class Density(NamedTuple):
    """What a policy thinks of all actions.

    Attributes:
        pixels: Log density less its highest over `DEPTH`, from 0 to 255, acceleration outermost [-].
        low: The lowest log density [nats].
        high: The highest log density [nats].
    """

    pixels: UInt8[np.ndarray, "A S"]
    low: float
    high: float


@runtime_checkable
class Mind(Protocol):
    """A policy that can be watched."""

    @property
    def name(self) -> str:
        """How the page calls it."""

    def begin(self, simulation: Simulation, seed: int) -> None:
        """Put the car where this policy starts with this seed, and forget the past."""

    def decide(self, simulation: Simulation, observation: Observation) -> Action:
        """Choose the action for the next control interval."""

    def take_over(self, simulation: Simulation) -> None:
        """Drive on from wherever a person has left the car."""

    def chosen_from(self) -> Density | None:
        """What it chose from last; it costs nothing. None where that was no landscape."""

    def density(self, observation: Observation) -> Density | None:
        """What it thinks of all actions, where it takes time to ask; None where it cannot be asked."""

    def points(self) -> Int8[np.ndarray, "I N 2"] | None:
        """Candidates of the last decision by iteration, in 1/127; None where there was no search."""


class ExpertMind:
    """An expert that takes random turns.

    Args:
        name: Which expert.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self._config = CollectConfig(expert=experts.known(name))

    def begin(self, simulation: Simulation, seed: int) -> None:
        """Start where `mjdrive drive` does."""
        lane, station = start(simulation, seed)
        self._expert = expert_of(self._config, simulation)
        self._seed = seed
        self._follow(simulation, lane, station)
        simulation.reset(lane=lane, station=station, seed=seed)
        self._expert.reset(seed)

    def decide(self, simulation: Simulation, observation: Observation) -> Action:
        """Ask the expert, who sees the truth."""
        del observation
        return self._expert.act(self._view(simulation))

    def take_over(self, simulation: Simulation) -> None:
        """Lay a new way from the lane where the car is."""
        vehicle = simulation.vehicle
        place = np.array([vehicle.x, vehicle.y])
        lane, seen = routing.nearest_lane(simulation.town, place, yaw=vehicle.yaw)
        self._follow(simulation, lane, seen.station)
        self._expert.reset(self._seed)

    def chosen_from(self) -> Density | None:
        """Experts think of one action alone."""
        return None

    def density(self, observation: Observation) -> Density | None:
        """Experts think of one action alone."""
        del observation
        return None

    def points(self) -> Int8[np.ndarray, "I N 2"] | None:
        """Experts draw nothing."""
        return None

    def _follow(self, simulation: Simulation, lane: str, station: float) -> None:
        walk = RandomWalk(
            simulation.town,
            lane=lane,
            station=station,
            rng=np.random.default_rng([self._seed, 1]),
        )
        self._view = FollowWalk(walk)


class GuestMind:
    """A policy of another package: it decides, and of what it thinks nothing is known.

    Args:
        name: How the page calls it.
        policy: The policy.
    """

    def __init__(self, name: str, policy: Policy[Observation]) -> None:
        self.name = name
        self._policy = policy

    def begin(self, simulation: Simulation, seed: int) -> None:
        """Start where `mjdrive drive` does."""
        lane, station = start(simulation, seed)
        simulation.reset(lane=lane, station=station, seed=seed)
        self._policy.reset(seed)

    def decide(self, simulation: Simulation, observation: Observation) -> Action:
        """Ask the policy."""
        del simulation
        return self._policy.act(observation)

    def take_over(self, simulation: Simulation) -> None:
        """Nothing to do: it sees where the car is."""

    def chosen_from(self) -> Density | None:
        """Its protocol knows actions alone."""
        return None

    def density(self, observation: Observation) -> Density | None:
        """Its protocol knows actions alone."""
        del observation
        return None

    def points(self) -> Int8[np.ndarray, "I N 2"] | None:
        """Its protocol knows no search."""
        return None


class PilotMind:
    """A trained policy.

    Args:
        pilot: The policy.
    """

    def __init__(self, pilot: Pilot) -> None:
        self.name = pilot.name
        self._pilot = pilot
        self._searched: list[torch.Tensor] = []
        self._scored: list[torch.Tensor] = []
        if isinstance(pilot.learner, IbcLearner):
            pilot.learner.on_candidates = self._searched.append
            pilot.learner.on_energies = self._scored.append

    def begin(self, simulation: Simulation, seed: int) -> None:
        """Start where `mjdrive drive` does."""
        lane, station = start(simulation, seed)
        simulation.reset(lane=lane, station=station, seed=seed)
        self._pilot.reset(seed)

    def decide(self, simulation: Simulation, observation: Observation) -> Action:
        """Ask the network."""
        del simulation
        self._searched.clear()
        self._scored.clear()
        return self._pilot.act(observation)

    def take_over(self, simulation: Simulation) -> None:
        """Nothing to do: it decides anew at every step."""

    @torch.inference_mode()
    def chosen_from(self) -> Density | None:
        """The grid that it chose from, if its sampler is one."""
        if not self._scored:
            return None
        (energies,) = self._scored
        return shade(-_thinned(energies[0]).double().cpu().numpy())

    @torch.inference_mode()
    def density(self, observation: Observation) -> Density:
        """Ask the network about a grid."""
        device = self._pilot.device
        bev = torch.tensor(observation.bev, device=device)[None]
        state = torch.tensor(observation.state, device=device)[None]
        grid = action_grid(POINTS).to(device)[None]
        values = self._pilot.learner.log_density(bev, state, grid)[0].double().cpu().numpy()
        return shade(values.reshape(POINTS, POINTS))

    def points(self) -> Int8[np.ndarray, "I N 2"] | None:
        """What the sampler looked at, thinned out evenly."""
        if not self._searched:
            return None
        kept = [it[0, :: max(1, it.shape[1] // MOST_CANDIDATES)] for it in self._searched]
        scaled = (127.0 * torch.stack(kept)).round().clamp(-127, 127)
        return scaled[:, :MOST_CANDIDATES].to(torch.int8).cpu().numpy()


def _thinned(energies: Float[torch.Tensor, " N"]) -> Float[torch.Tensor, "A S"]:
    """Energies of a square grid, the lowest of its points around each one that is shown."""
    side = round(len(energies) ** 0.5)
    square = energies.view(1, side, side)
    return -F.adaptive_max_pool2d(-square, min(side, POINTS))[0]


def shade(log_density: Float[np.ndarray, "A S"]) -> Density:
    """Turn log densities [nats] into the pixels of a landscape."""
    high = float(log_density.max())
    depth = np.clip((log_density - high) / DEPTH + 1.0, 0.0, 1.0)
    return Density((255.0 * depth).round().astype(np.uint8), float(log_density.min()), high)


def start(simulation: Simulation, seed: int) -> tuple[str, float]:
    """Draw the place where `mjdrive drive` starts with this seed: a lane and a station on it [m]."""
    seconds = STEPS_LIKE_DRIVE * simulation.config.control_interval
    length = PidConfig().target_speed * seconds + 50.0
    return routing.random_start(simulation.town, np.random.default_rng(seed), length=length)
