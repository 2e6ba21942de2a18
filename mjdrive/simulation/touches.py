"""Collisions and kerb strikes: which touches of the car are new events."""

import math
from collections.abc import Iterable

from mjdrive.config import RulesConfig
from mjdrive.datatypes import InfractionKind

Touch = tuple[InfractionKind, str]


class TouchWatch:
    """Watches what the car touches.

    The same thing, touched within `same_hit_time` or `same_hit_distance` of its last touch, is no new event: a car
    that leans on a wall, or scrapes along it, has hit it once.

    Args:
        config: Limits of the rules.
    """

    def __init__(self, config: RulesConfig) -> None:
        self._config = config
        self.reset()

    def reset(self) -> None:
        """Forget the drive so far."""
        self._last: dict[Touch, tuple[float, tuple[float, float]]] = {}

    def check(
        self, time: float, position: tuple[float, float], touches: Iterable[Touch]
    ) -> list[Touch]:
        """Judge one control step.

        Args:
            time: Simulation time since reset [s].
            position: Of the car, world frame [m].
            touches: Kind and name of everything that the car touched during the step.

        Returns:
            Those that are new events.
        """
        found = [touch for touch in touches if self._is_new(touch, time, position)]
        self._last.update(dict.fromkeys(touches, (time, position)))
        return found

    def _is_new(self, touch: Touch, time: float, position: tuple[float, float]) -> bool:
        if touch not in self._last:
            return True
        last_time, last_position = self._last[touch]
        return (
            time - last_time > self._config.same_hit_time
            and math.dist(position, last_position) > self._config.same_hit_distance
        )
