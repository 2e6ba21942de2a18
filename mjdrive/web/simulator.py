"""The thread that owns the simulation: it obeys pages and drives.

Whatever fails, a policy, a disk or the physics, must not end it: the drive stops, the pages say why, and people go on from there.
"""

import logging
import threading
import time
from typing import Any

from mjdrive.datatypes import Action
from mjdrive.errors import MjdriveError
from mjdrive.web.cockpit import Cockpit
from mjdrive.web.commands import Command
from mjdrive.web.inbox import Inbox
from mjdrive.web.narrator import Audience
from mjdrive.web.pace import Pace
from mjdrive.web.roles import ANSWERS_WITHIN
from mjdrive.web.session import Choice, Session

LOG = logging.getLogger(__name__)


class Simulator(threading.Thread):
    """Drives until it is stopped.

    Args:
        session: What is driven; from now on this thread's own.
        audience: Who is told.
        pace: Keeps it in step with the clock.

    Attributes:
        session: What is driven.
        inbox: What pages say, and who they are.
        cockpit: How it is driven.
        busy: Processor time of the thread until its last turn [s].
    """

    def __init__(self, session: Session, audience: Audience, pace: Pace | None = None) -> None:
        super().__init__(name="simulator", daemon=True)
        self.session = session
        self.inbox = Inbox()
        self.cockpit = Cockpit(session, audience, self.inbox, pace or Pace())
        self.busy = 0.0
        self._audience = audience
        self._is_ended = threading.Event()
        self._tell_terminal, session.on_progress = session.on_progress, audience.note

    def stop(self) -> None:
        """End the thread, wait until it has, and keep what was driven by hand."""
        self._is_ended.set()
        self.join()
        self.session.on_progress = self._tell_terminal  # the pages have gone
        try:
            self.session.keep_what_is_left()
        except MjdriveError as error:
            LOG.error("What was driven by hand is lost: %s", error)

    def run(self) -> None:
        """Obey and drive."""
        while not self._is_ended.is_set():
            self.turn()
            self.busy = time.thread_time()

    def turn(self) -> None:
        """Obey what pages have said, and drive one step unless that is paused."""
        try:
            self._hear()
            self.cockpit.turn()
        except Exception as error:  # told to all pages
            self.cockpit.stop_short(error)

    def _hear(self) -> None:
        for who, is_here in self.inbox.arrivals():
            self._meet(who) if is_here else self._part(who)
        if self.inbox.roles.is_unanswered:
            self._pass_control(f"Nobody answered for {ANSWERS_WITHIN:.0f} s.")
        for command, who in self.inbox.commands(wait=self.cockpit.is_waiting):
            self._obey(command, who)

    def _meet(self, who: object) -> None:
        self.inbox.roles.come(who)
        self.cockpit.tell_all()

    def _part(self, who: object) -> None:
        was_operator = who is self.inbox.roles.operator
        self.inbox.roles.leave(who)
        if was_operator:
            self._release(who)
        self.cockpit.announce()

    def _release(self, who: object) -> None:
        """Take the wheel from them, and keep what they drove: it is not for others to drop."""
        is_driver = self.inbox.wheel.give_back(who)
        try:
            self.session.keep_what_is_left()
        except MjdriveError as error:
            self._audience.note(str(error), is_error=True)
        if is_driver:
            self.cockpit.let_policy_drive()

    def _pass_control(self, why: str) -> None:
        roles = self.inbox.roles
        before = roles.operator
        roles.hand_over()
        if before is not roles.operator:
            self._release(before)
            self._audience.note(f"{why} You are in control now.", to=roles.operator)
            self._audience.note(f"{why} Another page is in control now.", to=before)
        self.cockpit.announce()

    def _obey(self, command: Command, who: object) -> None:
        if self.inbox.may(command, who):
            try:
                getattr(self, f"_on_{command.op}")(who, **command.values)
            except MjdriveError as error:
                self._audience.note(str(error), is_error=True)
        else:
            words = "Another page is in control; ask for control to change the drive."
            self._audience.note(words, is_error=True, to=who)
        self.cockpit.announce()

    def _on_control(self, who: object, *, on: bool) -> None:
        roles = self.inbox.roles
        if who is not roles.operator:
            roles.ask(who) if on else roles.take_back(who)
        elif on:
            for page in roles.asking:
                self._audience.note("The page in control keeps it.", to=page)
            roles.ask(who)
        else:
            self._pass_control("The page in control has handed over.")

    def _on_pause(self, who: object, *, on: bool) -> None:
        del who
        self.cockpit.pause(on=on)

    def _on_step(self, who: object) -> None:
        del who
        self.cockpit.step()

    def _on_force(self, who: object, *, acceleration: float, steering: float) -> None:
        del who
        if self.cockpit.is_paused:
            self.cockpit.step(Action(acceleration=acceleration, steering=steering))

    def _on_speed(self, who: object, *, factor: float) -> None:
        del who
        self.cockpit.set_speed(factor)

    def _on_reset(self, who: object) -> None:
        del who
        self.session.reset()
        self.cockpit.begin_anew()

    def _on_load(self, who: object, **wanted: Any) -> None:
        del who
        before = self.session.choice
        kept = {"town": before.town, "policy": before.policy, "seed": before.seed}
        if self.session.load(Choice(**{**kept, **wanted})):
            self._audience.tell("scene", b"")
        self.cockpit.begin_anew()

    def _on_wheel(self, who: object, *, on: bool) -> None:
        wheel = self.inbox.wheel
        if on and wheel.holder is None:
            self.session.begin_recording()
            wheel.take(who)
            if self.cockpit.fault:
                self.cockpit.pause(on=False)
        elif not on and wheel.give_back(who):
            self.cockpit.let_policy_drive()

    def _on_keep(self, who: object) -> None:
        del who
        if self.session.recording is not None:
            path = self.session.keep_recording()
            words = f"Kept as {path}; learn from it with mjdrive train --data {path.parent}"
            self._audience.note(words)

    def _on_drop(self, who: object) -> None:
        del who
        self.session.drop_recording()

    def _on_watch(self, who: object) -> None:
        del who
        self.cockpit.tell_all()
