"""What a manoeuvre drives: anything that takes pedals and steering and tells how it moves."""

from abc import ABC, abstractmethod
from collections.abc import Callable

from mjdrive.config import SimulationConfig
from mjdrive.datatypes import Action
from mjdrive.manoeuvres.recording import Moment, Recording
from mjdrive.manoeuvres.single_track import SingleTrack

UPDATE_INTERVAL = SimulationConfig().car_update_interval
"""Time between two commands, and between two rows of a recording [s]."""

Driver = Callable[[Moment], Action]
"""Chooses pedals and steering from how the car moves."""


class Plant(ABC):
    """A car on an endless plane: in MuJoCo, or as a model of a few equations.

    Args:
        single_track: The car as one track.
        max_steering_angle: At full lock [rad].
    """

    def __init__(self, single_track: SingleTrack, *, max_steering_angle: float) -> None:
        self.single_track = single_track
        self.max_steering_angle = max_steering_angle

    @abstractmethod
    def place(self, *, speed: float = 0.0) -> None:
        """Put the car at the origin, headed along x, rolling.

        Args:
            speed: Forward speed [m/s].
        """

    @abstractmethod
    def moment(self) -> Moment:
        """How the car moves now."""

    @abstractmethod
    def advance(self, action: Action) -> None:
        """Drive for one update interval.

        Args:
            action: What to do.
        """

    def drive(
        self,
        driver: Driver,
        *,
        duration: float,
        until: Callable[[Moment], bool] | None = None,
    ) -> Recording:
        """Let somebody drive and record it, from now on.

        Args:
            driver: Asked fifty times a second.
            duration: At most [s].
            until: Ends the manoeuvre early when it says so.

        Returns:
            The recording; its time begins at 0.

        Raises:
            PhysicsError: If the physics has become unstable.
        """
        start = self.moment().time
        moments = [self._since(start)]
        for _ in range(round(duration / UPDATE_INTERVAL)):
            self.advance(driver(moments[-1]))
            moments.append(self._since(start))
            if until is not None and until(moments[-1]):
                break
        return Recording.of(moments)

    def _since(self, start: float) -> Moment:
        moment = self.moment()
        return moment._replace(time=moment.time - start)


class SpeedHold:
    """A cruise control of two terms, for manoeuvres at constant speed.

    Args:
        speed: To hold [m/s].
    """

    PROPORTIONAL = 0.25  # [1/(m/s)]
    INTEGRAL = 0.2  # [1/m]
    BRAKE_SHARE = 0.2  # of the command that reaches the brake [-]

    def __init__(self, speed: float) -> None:
        self._speed = speed
        self._integral = 0.15

    def __call__(self, moment: Moment) -> float:
        """Acceleration command [-]."""
        error = self._speed - moment.speed
        self._integral += self.INTEGRAL * UPDATE_INTERVAL * error
        self._integral = min(max(self._integral, 0.0), 1.0)
        command = self.PROPORTIONAL * error + self._integral
        return min(command, 1.0) if command >= 0 else max(self.BRAKE_SHARE * command, -1.0)
