"""Drives a session turn by turn, by policy or by hand, and tells of it; where something fails, it stops and says why."""

import logging

from mjdrive.datatypes import Action
from mjdrive.errors import MjdriveError, PhysicsError
from mjdrive.web.inbox import Inbox
from mjdrive.web.narrator import Audience, Narrator
from mjdrive.web.pace import Pace
from mjdrive.web.session import Decision, Session

LOG = logging.getLogger(__name__)


class Cockpit:
    """What one thread drives with.

    Args:
        session: What is driven.
        audience: Who is told.
        inbox: Who holds the wheel, and who is who.
        pace: Keeps it in step with the clock.

    Attributes:
        is_paused: Whether it waits.
        fault: Why the drive stopped; empty if it did not.
        num_steps: Control steps since the beginning, whatever was reset [-].
    """

    def __init__(self, session: Session, audience: Audience, inbox: Inbox, pace: Pace) -> None:
        self.is_paused = False
        self.fault = ""
        self.num_steps = 0
        self._session, self._audience, self._inbox, self._pace = session, audience, inbox, pace
        self._tell = Narrator(session, audience, pace)
        self._decision: Decision | None = None
        self._next: Action | None = None  # what a page forces
        self._steps_left = 0

    @property
    def is_waiting(self) -> bool:
        """Whether nothing happens until somebody asks for it."""
        return self.is_paused and not self._steps_left

    def turn(self) -> None:
        """Decide, and drive for one control interval unless that is paused."""
        if self._decision is None and not self.fault:
            self._decision = self._decide()
            if self.is_waiting:
                self._tell_panel(self._decision, None, is_due=True)
        if self._decision is not None and not self.is_waiting:
            self._drive(self._decision)

    def pause(self, *, on: bool) -> None:
        """Wait, or go on; to go on is to try again what has failed."""
        self.is_paused = on
        self.fault = self.fault if on else ""
        self._pace.restart()

    def step(self, action: Action | None = None) -> None:
        """Drive one step and wait.

        Args:
            action: What to do in place of what would be done.
        """
        self.is_paused, self.fault = True, ""
        self._next, self._steps_left = action, 1
        self._pace.restart()

    def set_speed(self, factor: float) -> None:
        """Let so much simulated time pass in real time [-]."""
        self._pace.factor = factor
        self._pace.restart()

    def begin_anew(self) -> None:
        """Go on with a session that was put elsewhere."""
        self._decision, self.fault = None, ""
        self._pace.restart()
        self._tell.history()
        self._tell.pose(seq=self._inbox.wheel.seq)

    def let_policy_drive(self) -> None:
        """Go on from where a person has left the car."""
        self._decision = None
        try:
            self._session.mind.take_over(self._session.simulation)
        except Exception as error:  # policies of other people may raise anything
            self.stop_short(error)

    def stop_short(self, error: Exception) -> None:
        """Pause, and say why; what is no mistake of the user leaves its traceback in the terminal."""
        is_known = isinstance(error, MjdriveError)
        if not is_known:
            LOG.error("The drive has stopped.", exc_info=error)
        words = str(error) if is_known else f"{type(error).__name__}: {error}"
        choice = self._session.choice
        self.fault = f"{choice.policy} in {choice.town}: {words}"
        self._decision = self._next = None
        self.is_paused, self._steps_left = True, 0
        advice = "Play tries again; or reset, take the wheel, or choose something else."
        self._audience.note(f"The drive has stopped. {self.fault} {advice}", is_error=True)
        self.announce()

    def announce(self) -> None:
        """Tell what is chosen, how the drive stands, and who is who."""
        self._tell.state(self._inbox.standing, is_paused=self.is_paused, fault=self.fault)

    def tell_all(self) -> None:
        """Tell what those know who have listened from the start."""
        self._tell.history()
        self._tell.pose(seq=self._inbox.wheel.seq)
        if self._decision is not None:
            self._tell_panel(self._decision, None, is_due=True)
        self.announce()

    def _decide(self) -> Decision:
        try:
            return self._session.decide()
        except Exception:
            if not self._is_by_hand:
                raise
            return self._session.look()  # a person drives on, whatever the policy does

    @property
    def _is_by_hand(self) -> bool:
        """Whether a person drives; what they force while it is paused is a part of what they drive."""
        return self._inbox.wheel.holder is not None

    def _tell_panel(self, decision: Decision, driven: Action | None, *, is_due: bool) -> None:
        self._tell.panel(decision, driven, by_hand=self._is_by_hand, is_due=is_due)

    def _action(self, decision: Decision) -> Action:
        """What is done now: what a page forces, what the wheel says, or what the policy chose."""
        if self._next is not None:
            forced, self._next = self._next, None
            return forced
        if self._is_by_hand:
            return self._inbox.wheel.action(self._session.simulation.config.control_interval)
        assert decision.action is not None, "who lets go lets the policy decide anew"
        return decision.action

    def _drive(self, decision: Decision) -> None:
        by_hand, action = self._is_by_hand, self._action(decision)
        self._tell_panel(decision, action, is_due=False)
        try:
            found = self._session.step(action, on_motion=self._on_motion, by_hand=by_hand)
        except PhysicsError as error:
            self._audience.note(f"{error} The drive starts again.", is_error=True)
            self._session.reset()
            self.begin_anew()
            return
        self._decision = None
        self.num_steps += 1
        self._steps_left = max(self._steps_left - 1, 0)
        grows = self._session.recording is not None and self._tell.is_state_due
        if found or grows or self.is_paused:
            self.announce()

    def _on_motion(self) -> None:
        """Called as the car moves: keep the pace and tell where it is."""
        self._pace.beat(self._session.simulation.config.car_update_interval)
        self._tell.pose(seq=self._inbox.wheel.seq, is_due=self.is_paused)
