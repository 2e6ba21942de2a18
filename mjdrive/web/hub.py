"""The pages that are open, told from any thread; what they are told waits in an outbox each."""

import asyncio
from collections.abc import Callable
from typing import Any

from mjdrive.page import wire
from mjdrive.web.outbox import Outbox
from mjdrive.web.roles import Standing

POSES_WHILE_HIDDEN = 50
"""A hidden page gets one pose of so many [-]."""

BEAT_INTERVAL = 5.0
"""Between two signs of life [s]."""


class Hub:
    """All open pages.

    Attributes:
        pages: Their outboxes.
    """

    def __init__(self) -> None:
        self.pages: frozenset[Outbox] = frozenset()  # replaced, never changed: others look at it
        self._loop: asyncio.AbstractEventLoop | None = None
        self._num_poses = self._num_notes = self._num_pages = 0
        self._state: tuple[dict[str, Any], Standing] | None = None  # as it was told last

    def attach(self, loop: asyncio.AbstractEventLoop) -> None:
        """Speak through this event loop from now on."""
        self._loop = loop

    def add(self, page: Outbox) -> None:
        """A page has come; it gets a number that no other page had."""
        self._num_pages += 1
        page.number = self._num_pages
        self.pages |= {page}

    def remove(self, page: Outbox) -> None:
        """A page has gone."""
        self.pages -= {page}

    def set_slow(self, page: Outbox, is_slow: bool) -> None:
        """A page's link is slow from now on, or no longer; it hears that this was understood."""
        page.slow = is_slow
        if self._state is not None:
            self._put_state(*self._state)

    async def beat(self) -> None:
        """Give signs of life, for ever: what is paused and what is dead looks alike to a page."""
        while True:
            self._put("beat", wire.pack("beat", {}))
            await asyncio.sleep(BEAT_INTERVAL)

    def tell(self, kind: str, message: bytes) -> None:
        """Send a binary message to all; "scene" only says that there is another one."""
        if kind == "scene":
            self._call(self._put_text, "scene", wire.text("scene", {}), None)
        else:
            self._call(self._put, kind, message)

    def tell_state(self, values: dict[str, Any], standing: Standing) -> None:
        """Send to all what is chosen, and to each who it is."""
        self._call(self._put_state, values, standing)

    def note(self, line: str, *, is_error: bool = False, to: object | None = None) -> None:
        """Send a line for people to one, or to all."""
        self._num_notes += 1  # none takes the place of another
        message = wire.text("note", {"line": line, "error": is_error})
        self._call(self._put_text, f"note-{self._num_notes}", message, to)

    @property
    def is_open(self) -> bool:
        """Whether there is any page."""
        return bool(self.pages)

    @property
    def is_watching(self) -> bool:
        """Whether anybody looks."""
        return any(not page.hidden for page in self.pages)

    def _call(self, function: Callable[..., None], *args: Any) -> None:
        if self.pages and self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(function, *args)

    def _put_text(self, kind: str, message: str, to: object | None) -> None:
        for page in self.pages:
            if to is None or page is to:
                page.put_text(kind, message)

    def _put(self, kind: str, message: bytes) -> None:
        self._num_poses += kind == "pose"
        is_rare = kind == "beat" or (kind == "pose" and not self._num_poses % POSES_WHILE_HIDDEN)
        pages = [page for page in self.pages if is_rare or not page.hidden]
        deflated = wire.deflated(message) if any(page.slow for page in pages) else message
        for page in pages:
            page.put(kind, deflated if page.slow else message)

    def _put_state(self, values: dict[str, Any], standing: Standing) -> None:
        told = {
            **values,
            "pages": len(self.pages),
            "operator": _number(standing.operator),
            "driver": _number(standing.driver),
            "asking": [_number(page) for page in standing.asking],
        }
        driver, self._state = standing.driver, (values, standing)
        for page in self.pages:
            wheel = "free" if driver is None else "yours" if driver is page else "taken"
            own = {"you": page.number, "wheel": wheel, "link": "slow" if page.slow else "full"}
            page.put_text("state", wire.text("state", {**told, **own}))


def _number(page: object | None) -> int:
    """How people call a page; 0 is nobody."""
    return page.number if isinstance(page, Outbox) else 0
