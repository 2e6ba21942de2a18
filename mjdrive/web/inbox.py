"""What pages say, from any thread, and who they are: in order for the simulator, keys at once to the wheel."""

import queue
from collections.abc import Iterator

from mjdrive.web.commands import CONTROLS, Command
from mjdrive.web.roles import Roles, Standing
from mjdrive.web.wheel import Wheel

MOST_COMMANDS = 64
"""That wait to be obeyed; more are refused [-]."""

IDLE = 0.1
"""How long a paused simulation waits for a command [s]."""


class Inbox:
    """Commands that wait, and pages that have come and gone.

    Attributes:
        wheel: The wheel that the page in control takes.
        roles: Who is in control; changed by the one thread that obeys.
    """

    def __init__(self) -> None:
        self.wheel = Wheel()
        self.roles = Roles()
        self._commands: queue.Queue[tuple[Command, object]] = queue.Queue(MOST_COMMANDS)
        # Apart: a page that goes must be heard of however many commands wait.
        self._arrivals: queue.SimpleQueue[tuple[object, bool]] = queue.SimpleQueue()

    def come(self, who: object) -> None:
        """A page has come."""
        self._arrivals.put((who, True))

    def leave(self, who: object) -> None:
        """A page has gone."""
        self._arrivals.put((who, False))

    def put(self, command: Command, who: object) -> bool:
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

    def arrivals(self) -> Iterator[tuple[object, bool]]:
        """Who has come (True) and gone (False) since last asked."""
        while not self._arrivals.empty():
            yield self._arrivals.get()

    def commands(self, *, wait: bool) -> Iterator[tuple[Command, object]]:
        """What is asked for, and by whom.

        Args:
            wait: Whether to wait a little for the first one.
        """
        try:
            while True:
                yield self._commands.get(block=wait, timeout=IDLE)
                wait = False
        except queue.Empty:
            return

    def may(self, command: Command, who: object) -> bool:
        """Whether it is obeyed if this page says it."""
        return command.op not in CONTROLS or who is self.roles.operator

    @property
    def standing(self) -> Standing:
        """Who is what now."""
        return Standing(self.roles.operator, self.roles.asking, self.wheel.holder)
