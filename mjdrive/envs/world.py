"""What Gymnasium and dm_env have in common: a simulation that starts anywhere, rewards and ends."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from mjdrive.config import EnvConfig
from mjdrive.datatypes import Action, Infraction
from mjdrive.envs import rewards
from mjdrive.envs.lane_sense import LaneSense
from mjdrive.envs.tally import Tally
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library, routing
from mjdrive.vehicle import cars


class Outcome(NamedTuple):
    """What one control step brought.

    Attributes:
        terms: Terms of the reward by name [-].
        infractions: Breaches of the rules.
        is_over: Whether one of them ends the episode.
    """

    terms: Mapping[str, float]
    infractions: tuple[Infraction, ...]
    is_over: bool

    @property
    def reward(self) -> float:
        """Sum of the terms [-]."""
        return sum(self.terms.values())


class World:
    """A town with a car to learn in.

    Args:
        town: Name of the town.
        car: Name or MJCF file of the car.
        config: Rewards and endings.

    Attributes:
        simulation: The simulation itself.
        tally: Figures of the drive so far.

    Raises:
        UnknownNameError: If there is no such town.
        CarError: If there is no such car.
    """

    def __init__(
        self, town: str, *, car: str = cars.DEFAULT, config: EnvConfig | None = None
    ) -> None:
        self.simulation = Simulation(library.load(town), car=cars.load(car))
        self._config = config or EnvConfig()
        self._lanes = LaneSense(self.simulation.town, self.simulation.car.parameters)
        self.tally = Tally(self.simulation.vehicle, on_lane=False)

    def start(
        self, rng: np.random.Generator, *, lane: str | None = None, station: float = 0.0
    ) -> None:
        """Begin a drive.

        Args:
            rng: Decides the place, if none is named, and the time into the light cycle.
            lane: Name of the lane to start on; a random place if None.
            station: Place of the rear axle along the named lane [m].

        Raises:
            RouteError: If there is no such place.
        """
        light_seed = int(rng.integers(2**32))
        if lane is None:
            lane, station = routing.random_start(self.simulation.town, rng)
        self.simulation.reset(lane=lane, station=station, seed=light_seed)
        self.tally = Tally(self.simulation.vehicle, on_lane=self.simulation.is_on_lane)

    def step(self, action: Action) -> Outcome:
        """Drive for one control interval."""
        simulation = self.simulation
        before = simulation.vehicle
        infractions = simulation.step(action)
        after = simulation.vehicle
        self.tally.add(after, infractions, on_lane=simulation.is_on_lane)
        terms = rewards.terms(
            self._config.reward,
            before=before,
            after=after,
            in_lane=self._lanes.follows(after),
            infractions=infractions,
            interval=simulation.config.control_interval,
        )
        names = {rewards.INFRACTION_TERMS[infraction.kind] for infraction in infractions}
        return Outcome(terms, infractions, is_over=not names.isdisjoint(self._config.ends_on))
