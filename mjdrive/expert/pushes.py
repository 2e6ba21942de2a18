"""Whether something else than its own commands has moved the car of the MPC expert, and whether it is back."""

from mjdrive.datatypes import Action, Situation
from mjdrive.expert.frenet import frenet_state

PUSHED = 0.06
"""Wheels this far from their command have been turned by something else than the rack [rad]."""

RECOVERED_OFFSET = 0.25
RECOVERED_HEADING = 0.12
"""A pushed car is back when it is this near to its route [m] and to its direction [rad]."""


class PushWatch:
    """Sees a push in the wheels, and remembers it until the car is back on its line.

    Plans are smooth: their commands move no faster than the rack. Against a push that uses up the rack's rate that is
    too slow, and a wheel that is late winds the plan up (docs/notes.md); the PID's command jumps.

    Args:
        max_steering_angle: Of the wheels, that a command of 1 asks for [rad].
    """

    def __init__(self, max_steering_angle: float) -> None:
        self._full_lock = max_steering_angle
        self._is_recovering = False

    def forget(self) -> None:
        """Begin anew."""
        self._is_recovering = False

    def look(self, view: Situation, last: Action | None, *, follows_plan: bool) -> bool:
        """Whether to recover in the next interval.

        Args:
            view: What is known now.
            last: The last command, None if there was none.
            follows_plan: Whether it came out of a plan.
        """
        self._is_recovering = self._recovers(view, last, follows_plan)
        return self._is_recovering

    def _recovers(self, view: Situation, last: Action | None, follows_plan: bool) -> bool:
        if last is None:
            return False
        command = last.steering * self._full_lock
        is_pushed = abs(view.vehicle.steering_angle - command) > PUSHED
        if is_pushed and (self._is_recovering or follows_plan):
            return True
        offset, heading_error = frenet_state(view)
        is_back = abs(offset) < RECOVERED_OFFSET and abs(heading_error) < RECOVERED_HEADING
        return self._is_recovering and not is_back
