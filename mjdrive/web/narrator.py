"""Tells an audience of a drive: no more often than people can see, and nothing where nobody listens."""

import time
from typing import Any, Protocol, runtime_checkable

from mjdrive.datatypes import Action
from mjdrive.web.pace import Pace
from mjdrive.web.policies import Density
from mjdrive.web.roles import Standing
from mjdrive.web.session import Decision, Session
from mjdrive.web.telling import history_message, panel_message, pose_message, state_values

POSE_INTERVAL = 1.0 / 60.0
PANEL_INTERVAL = 1.0 / 20.0
STATE_INTERVAL = 1.0 / 5.0
"""Shortest time between two messages of a kind, where nothing but time has passed [s]."""


@runtime_checkable
class Audience(Protocol):
    """Whoever is told; callable from any thread."""

    def tell(self, kind: str, message: bytes) -> None:
        """Send a binary message to all."""

    def tell_state(self, values: dict[str, Any], standing: Standing) -> None:
        """Send to all what is chosen, and to each who it is."""

    def note(self, line: str, *, is_error: bool = False, to: object | None = None) -> None:
        """Send a line for people to one, or to all."""

    @property
    def is_open(self) -> bool:
        """Whether there is any page."""

    @property
    def is_watching(self) -> bool:
        """Whether anybody looks."""


class Narrator:
    """Puts a session into messages.

    Args:
        session: What is driven.
        audience: Who is told.
        pace: How the simulation keeps up; a landscape that has to be made is left out where there is no time for it.
    """

    def __init__(self, session: Session, audience: Audience, pace: Pace) -> None:
        self._session, self._audience, self._pace = session, audience, pace
        self._last = {"pose": 0.0, "panel": 0.0, "state": 0.0}
        self._density: tuple[Decision, Density] | None = None  # the last one, and of what

    def state(self, standing: Standing, *, is_paused: bool, fault: str) -> None:
        """Tell what is chosen, how the drive stands, and why it stopped."""
        self._last["state"] = time.perf_counter()
        if self._audience.is_open:
            speed = self._pace.factor
            values = state_values(self._session, is_paused=is_paused, speed=speed, fault=fault)
            self._audience.tell_state(values, standing)

    def pose(self, *, seq: int, is_due: bool = True) -> None:
        """Tell where the car is; `is_due` if it must be told now."""
        if self._audience.is_open and (is_due or self._has_passed("pose", POSE_INTERVAL)):
            self._last["pose"] = time.perf_counter()
            message = pose_message(self._session, seq=seq, rate=self._pace.rate)
            self._audience.tell("pose", message)

    def panel(
        self, decision: Decision, driven: Action | None, *, by_hand: bool, is_due: bool
    ) -> None:
        """Tell what the policy sees and thinks.

        Args:
            decision: Its decision.
            driven: What is done now; None while that is open.
            by_hand: Whether a person drives.
            is_due: Whether it must be told now, with the landscape, however long that takes.
        """
        if not self._audience.is_watching:
            return
        if not (is_due or self._has_passed("panel", PANEL_INTERVAL)):
            return
        self._last["panel"] = time.perf_counter()
        density = points = None
        if decision.action is not None:
            density = self._landscape(decision, is_due=is_due)
            points = self._session.mind.points()
        message = panel_message(
            self._session, decision, density, points, driven=driven, by_hand=by_hand
        )
        self._audience.tell("panel", message)

    def _landscape(self, decision: Decision, *, is_due: bool) -> Density | None:
        """What the policy chose from, which costs nothing; else what it answers, where there is time to ask."""
        if self._density is not None and self._density[0] is decision:
            return self._density[1]
        mind = self._session.mind
        density = mind.chosen_from()
        if density is None and (is_due or not self._pace.is_late):
            density = mind.density(decision.observation)
        self._density = None if density is None else (decision, density)
        return density

    def history(self) -> None:
        """Tell the drive so far."""
        self._audience.tell("history", history_message(self._session))

    @property
    def is_state_due(self) -> bool:
        """Whether what grows with time should be told again."""
        return self._has_passed("state", STATE_INTERVAL)

    def _has_passed(self, kind: str, interval: float) -> bool:
        return time.perf_counter() - self._last[kind] >= interval
