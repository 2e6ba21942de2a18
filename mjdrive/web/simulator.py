"""The thread that owns the simulation: it obeys pages, drives, and tells them what happens."""

import queue
import threading
import time
from typing import Any, Protocol, runtime_checkable

from mjdrive.datatypes import Action
from mjdrive.errors import MjdriveError
from mjdrive.web.commands import Command
from mjdrive.web.pace import Pace
from mjdrive.web.session import Choice, Decision, Session
from mjdrive.web.telling import history_message, panel_message, pose_message, state_values
from mjdrive.web.wheel import Wheel

MOST_COMMANDS = 64
"""That wait to be obeyed; more are refused [-]."""

POSE_INTERVAL = 1.0 / 60.0
"""Shortest time between two poses [s]."""

IDLE = 0.1
"""How long a paused simulation waits for a command [s]."""


@runtime_checkable
class Audience(Protocol):
    """Whoever is told; callable from any thread."""

    def tell(self, kind: str, message: bytes) -> None:
        """Send a binary message to all."""

    def tell_state(self, values: dict[str, Any], holder: object | None) -> None:
        """Send to all what is chosen, and to each who drives."""

    def note(self, line: str, *, is_error: bool = False) -> None:
        """Send all a line for people."""

    @property
    def is_watching(self) -> bool:
        """Whether anybody looks."""


class Simulator(threading.Thread):
    """Drives until it is stopped.

    Args:
        session: What is driven; from now on this thread's own.
        audience: Who is told.

    Attributes:
        wheel: The wheel that pages take.
        is_paused: Whether it waits.
    """

    def __init__(self, session: Session, audience: Audience) -> None:
        super().__init__(name="simulator", daemon=True)
        self.session = session
        self.wheel = Wheel()
        self.is_paused = False
        self._audience = audience
        self._commands: queue.Queue[tuple[Command, object]] = queue.Queue(MOST_COMMANDS)
        self._pace = Pace()
        self._decision: Decision | None = None
        self._next: Action | None = None  # what a page forces
        self._steps_left = 0
        self._last_pose = 0.0
        self._is_ended = threading.Event()
        self._is_left = threading.Event()
        session.on_progress = audience.note

    def ask(self, command: Command, who: object) -> bool:
        """Let a command wait to be obeyed; whether there was room. Keys are heard at once."""
        values = command.values
        if command.op == "keys":
            self.wheel.say(who, keys=values["down"], seq=values["seq"])
        elif command.op == "steer":
            analog = values["acceleration"], values["steering"]
            self.wheel.say(who, analog=analog, seq=values["seq"])
        else:
            try:
                self._commands.put_nowait((command, who))
            except queue.Full:
                return False
        return True

    def leave(self, who: object) -> None:
        """A page has gone: let go of the wheel if it held it, however full the queue is."""
        if self.wheel.give_back(who):
            self._is_left.set()

    def stop(self) -> None:
        """End the thread, and wait until it has."""
        self._is_ended.set()
        self.join()

    def run(self) -> None:
        """Obey, decide, drive."""
        self._announce()
        while not self._is_ended.is_set():
            if self._is_left.is_set():
                self._is_left.clear()
                self._let_policy_drive()
            self._obey_all(wait=self.is_paused and not self._steps_left)
            if self._decision is None:
                self._decide()
            if not self.is_paused or self._steps_left:
                self._drive()

    def _obey_all(self, *, wait: bool) -> None:
        try:
            while True:
                command, who = (
                    self._commands.get(timeout=IDLE) if wait else self._commands.get_nowait()
                )
                wait = False
                self._obey(command, who)
        except queue.Empty:
            return

    def _obey(self, command: Command, who: object) -> None:
        try:
            getattr(self, f"_on_{command.op}")(who, **command.values)
        except MjdriveError as error:
            self._audience.note(str(error), is_error=True)
        self._announce()

    def _on_pause(self, who: object, *, on: bool) -> None:
        del who
        self.is_paused = on
        self._pace.restart()

    def _on_step(self, who: object) -> None:
        self._on_pause(who, on=True)
        self._steps_left = 1

    def _on_force(self, who: object, *, acceleration: float, steering: float) -> None:
        if self.is_paused:
            self._next = Action(acceleration=acceleration, steering=steering)
            self._on_step(who)

    def _on_speed(self, who: object, *, factor: float) -> None:
        del who
        self._pace.factor = factor
        self._pace.restart()

    def _on_reset(self, who: object) -> None:
        del who
        self.session.reset()
        self._begin_anew()

    def _on_load(self, who: object, **wanted: Any) -> None:
        del who
        before = self.session.choice
        kept = {"town": before.town, "policy": before.policy, "seed": before.seed}
        if self.session.load(Choice(**{**kept, **wanted})):
            self._audience.tell("scene", b"")
        self._begin_anew()

    def _on_wheel(self, who: object, *, on: bool) -> None:
        if on and self.wheel.holder is None:
            self.wheel.take(who)
            self.session.begin_recording()
        elif not on and self.wheel.give_back(who):
            self._let_policy_drive()

    def _let_policy_drive(self) -> None:
        self.session.mind.take_over(self.session.simulation)
        self._decision = None
        self._announce()

    def _on_keep(self, who: object) -> None:
        del who
        if self.session.recording is not None:
            path = self.session.keep_recording()
            self._audience.note(
                f"Kept as {path}; learn from it with mjdrive train --data {path.parent}"
            )

    def _on_watch(self, who: object) -> None:
        """A page has come: tell it all that others know already."""
        del who
        self._audience.tell("history", history_message(self.session))
        self._audience.tell("pose", self._pose())
        if self._decision is not None:
            self._tell_panel(self._decision)

    def _begin_anew(self) -> None:
        self._decision = None
        self._pace.restart()
        self._audience.tell("history", history_message(self.session))

    def _announce(self) -> None:
        values = state_values(self.session, is_paused=self.is_paused, speed=self._pace.factor)
        self._audience.tell_state(values, self.wheel.holder)

    def _decide(self) -> None:
        self._decision = self.session.decide()
        self._tell_panel(self._decision)

    def _tell_panel(self, decision: Decision) -> None:
        """Tell what the policy sees and thinks; the landscape is left out where there is no time for it."""
        if not self._audience.is_watching:
            return
        density, points = None, None
        if self.is_paused or not self._pace.is_late:
            density = self.session.mind.density(decision.observation)
            points = self.session.mind.points()
        by_hand = self.wheel.holder is not None
        message = panel_message(self.session, decision, density, points, by_hand=by_hand)
        self._audience.tell("panel", message)

    def _drive(self) -> None:
        assert self._decision is not None, "there is a decision before each step"
        interval = self.session.simulation.config.control_interval
        action, by_hand = self._decision.action, False
        if self._next is not None:
            action, self._next = self._next, None
        elif self.wheel.holder is not None:
            action, by_hand = self.wheel.action(interval), True
        try:
            found = self.session.step(action, on_motion=self._on_motion, by_hand=by_hand)
        except MjdriveError as error:
            self._audience.note(f"{error} The drive starts again.", is_error=True)
            self.session.reset()
            self._begin_anew()
            return
        self._decision = None
        self._steps_left = max(self._steps_left - 1, 0)
        if found or self.session.recording is not None or self.is_paused:
            self._announce()

    def _on_motion(self) -> None:
        """Called as the car moves: keep the pace and tell where it is."""
        self._pace.beat(self.session.simulation.config.car_update_interval)
        now = time.perf_counter()
        if now - self._last_pose >= POSE_INTERVAL or self.is_paused:
            self._last_pose = now
            self._audience.tell("pose", self._pose())

    def _pose(self) -> bytes:
        return pose_message(self.session, seq=self.wheel.seq, rate=self._pace.rate)
