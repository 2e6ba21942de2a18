"""The pages that are open, told from any thread; what they are told waits in an outbox each."""

import asyncio
from typing import Any

from mjdrive.web import wire
from mjdrive.web.outbox import Outbox

POSES_WHILE_HIDDEN = 50
"""A hidden page gets one pose of so many [-]."""


class Hub:
    """All open pages.

    Attributes:
        pages: Their outboxes.
    """

    def __init__(self) -> None:
        self.pages: frozenset[Outbox] = frozenset()  # replaced, never changed: others look at it
        self._loop: asyncio.AbstractEventLoop | None = None
        self._num_poses = self._num_notes = 0

    def attach(self, loop: asyncio.AbstractEventLoop) -> None:
        """Speak through this event loop from now on."""
        self._loop = loop

    def add(self, page: Outbox) -> None:
        """A page has come."""
        self.pages |= {page}

    def remove(self, page: Outbox) -> None:
        """A page has gone."""
        self.pages -= {page}

    def tell(self, kind: str, message: bytes) -> None:
        """Send a binary message to all; "scene" only says that there is another one."""
        if kind == "scene":
            self._soon("scene", wire.text("scene", {}))
        else:
            self._call(self._put, kind, message)

    def tell_state(self, values: dict[str, Any], holder: object | None) -> None:
        """Send to all what is chosen, and to each who drives."""
        self._call(self._put_state, values, holder)

    def note(self, line: str, *, is_error: bool = False) -> None:
        """Send all a line for people."""
        self._num_notes += 1  # none takes the place of another
        self._soon(f"note-{self._num_notes}", wire.text("note", {"line": line, "error": is_error}))

    @property
    def is_watching(self) -> bool:
        """Whether anybody looks."""
        return any(not page.hidden for page in self.pages)

    def _call(self, function: Any, *args: Any) -> None:
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(function, *args)

    def _soon(self, kind: str, message: str) -> None:
        self._call(self._put_text, kind, message)

    def _put_text(self, kind: str, message: str) -> None:
        for page in self.pages:
            page.put_text(kind, message)

    def _put(self, kind: str, message: bytes) -> None:
        self._num_poses += kind == "pose"
        for page in self.pages:
            if not page.hidden or (kind == "pose" and self._num_poses % POSES_WHILE_HIDDEN == 0):
                page.put(kind, message)

    def _put_state(self, values: dict[str, Any], holder: object | None) -> None:
        for page in self.pages:
            wheel = "free" if holder is None else "yours" if holder is page else "taken"
            told = {**values, "wheel": wheel, "pages": len(self.pages)}
            page.put_text("state", wire.text("state", told))
