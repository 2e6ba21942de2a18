"""Stuck: standing for so long that no light can be the reason."""

from mjdrive.config import RulesConfig

CAUSE = "standstill"
"""What infractions name as the cause of being stuck."""

_ROUNDING = 1e-6
"""Clocks that add up control intervals may be this late [s]."""


class StandstillWatch:
    """Watches whether the car stays slower than `stuck_speed` for `stuck_time`; each standstill counts once.

    Args:
        config: Limits of the rules.
    """

    def __init__(self, config: RulesConfig) -> None:
        self._config = config
        self.reset()

    def reset(self) -> None:
        """Forget the drive so far."""
        self._since: float | None = None
        self._has_counted = False

    def check(self, time: float, speed: float) -> str | None:
        """Judge one control step.

        Args:
            time: Simulation time since reset [s].
            speed: Of the car, negative backwards [m/s].

        Returns:
            `CAUSE` if the car is stuck since now.
        """
        if abs(speed) >= self._config.stuck_speed:
            self.reset()
            return None
        if self._since is None:
            self._since = time
        is_stuck = time - self._since >= self._config.stuck_time - _ROUNDING
        if not is_stuck or self._has_counted:
            return None
        self._has_counted = True
        return CAUSE
