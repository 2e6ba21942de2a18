"""An episode lived again: the simulation in each of its states, as its policy met it."""

import mujoco

from mjdrive.datatypes import Action, Episode, Observation, Town
from mjdrive.errors import DataError
from mjdrive.simulation.simulation import Simulation, Snapshot
from mjdrive.town import library
from mjdrive.vehicle import cars
from mjdrive.vehicle.cars import CarModel

TOWN_DIGEST, CAR, CAR_DIGEST = "town_digest", "car", "car_digest"
"""Under these names `Episode.metadata` holds what was driven where."""


def town_of(episode: Episode) -> Town:
    """Load the town that an episode was driven in.

    Raises:
        DataError: If it has changed since.
        UnknownNameError: If it is not installed.
    """
    town = library.load(episode.town)
    driven = episode.metadata.get(TOWN_DIGEST, town.digest)
    if driven != town.digest:
        raise DataError(
            f"The episode was driven in {episode.town} {driven[:12]}; installed is {town.digest[:12]}, another map or town "
            f"format. Drive it again: `mjdrive drive --town {episode.town} --seed {episode.seed}`."
        )
    return town


def car_of(episode: Episode, *, name: str | None = None) -> CarModel:
    """Load the car that an episode was driven with.

    Args:
        episode: The drive; those of before one could choose were the default car's.
        name: Name or MJCF file of the car; what the episode says if None.

    Raises:
        DataError: If it is another car.
        CarError: If its file cannot be used.
        UnknownNameError: If there is no such car.
    """
    driven = episode.metadata.get(CAR, cars.DEFAULT)
    if name is None and driven not in cars.SHIPPED:
        raise DataError(
            f"The episode was driven with the car '{driven}', which does not come with mjdrive; give its file with --car."
        )
    car = cars.load(name or driven)
    digest = episode.metadata.get(CAR_DIGEST, car.digest)
    if digest != car.digest:
        raise DataError(
            f"The episode was driven with the car '{driven}' {digest[:12]}; '{car.name}' is {car.digest[:12]}, another one. "
            f"Give the MJCF file that was driven with --car, or drive again."
        )
    return car


class Playback:
    """Puts a simulation into the states of an episode.

    Args:
        episode: The drive.
        car: Name or MJCF file of the car; what the episode says if None.

    Attributes:
        episode: The drive.
        simulation: The world in the state that was shown last.

    Raises:
        DataError: If town or car are not those of the episode.
    """

    def __init__(self, episode: Episode, *, car: str | None = None) -> None:
        self.episode = episode
        town = town_of(episode)
        self.simulation = Simulation(town, car=car_of(episode, name=car))
        size = len(self.simulation.car.save())
        if episode.physics.shape[1] != size:
            raise DataError(
                f"The episode has {episode.physics.shape[1]} numbers of physics a step; MuJoCo {mujoco.__version__} with this "
                f"town and car has {size}. Drive it again, or take the version that it was driven with."
            )

    def show(self, step: int) -> None:
        """Put the simulation where it was when an action was chosen.

        Args:
            step: Which action, from 0 [-].
        """
        episode, interval = self.episode, self.simulation.config.control_interval
        acceleration, steering = episode.actions[step - 1].tolist() if step else (0.0, 0.0)
        self.simulation.restore(
            Snapshot(
                episode.physics[step],
                round(float(episode.time[step]) / interval),
                episode.light_phase,
                Action(acceleration, steering),
            )
        )

    def observe(self) -> Observation:
        """What a learned policy saw in the state that is shown."""
        return self.simulation.observe()
