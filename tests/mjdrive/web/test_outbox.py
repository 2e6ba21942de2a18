"""A slow page loses pictures; it never delays anybody and never sees old ones."""

import asyncio
import contextlib
from collections.abc import Awaitable, Callable

from anyio.from_thread import start_blocking_portal

from mjdrive.web.outbox import WINDOW, Outbox


class Page:
    """A page that notes what it gets."""

    def __init__(self) -> None:
        self.got: list[bytes] = []
        self.heard: list[str] = []

    async def send(self, message: bytes) -> None:
        self.got.append(message)

    async def send_text(self, message: str) -> None:
        self.heard.append(message)


def play(scenario: Callable[[], Awaitable[None]]) -> None:
    """Play it in a thread of its own: in this one a browser's loop may run."""
    with start_blocking_portal() as portal:
        portal.call(scenario)


async def pumped(outbox: Outbox) -> None:
    """Let the outbox send all that it may."""
    pump = asyncio.create_task(outbox.pump())
    await asyncio.sleep(0.02)
    pump.cancel()
    with contextlib.suppress(asyncio.CancelledError):
        await pump


def test_a_page_that_acknowledges_nothing_gets_a_window_and_then_the_newest() -> None:
    async def scenario() -> None:
        page = Page()
        outbox = Outbox(page.send, page.send_text)
        for number in range(100):
            outbox.put("pose", str(number).encode())
            await pumped(outbox)
        assert page.got == [str(number).encode() for number in range(WINDOW)]
        assert outbox.dropped == 100 - WINDOW - 1
        outbox.acknowledge(1)
        await pumped(outbox)
        assert page.got[-1] == b"99"

    play(scenario)


def test_kinds_do_not_take_each_others_place() -> None:
    async def scenario() -> None:
        page = Page()
        outbox = Outbox(page.send, page.send_text)
        outbox.put("pose", b"pose")
        outbox.put("panel", b"panel")
        outbox.put_text("state", "state")
        await pumped(outbox)
        assert sorted(page.got) == [b"panel", b"pose"]
        assert page.heard == ["state"]

    play(scenario)


def test_what_waits_when_a_drive_begins_anew_is_of_another_drive() -> None:
    async def scenario() -> None:
        page = Page()
        outbox = Outbox(page.send, page.send_text)
        outbox.put("panel", b"old panel")
        outbox.put("pose", b"old pose")
        outbox.put("history", b"nothing yet")
        outbox.put("panel", b"new panel")
        await pumped(outbox)
        assert page.got == [b"nothing yet", b"new panel"]
        assert outbox.dropped == 2

    play(scenario)


def test_a_page_cannot_acknowledge_what_was_not_sent() -> None:
    async def scenario() -> None:
        page = Page()
        outbox = Outbox(page.send, page.send_text)
        outbox.acknowledge(1_000_000)
        assert outbox.acknowledged == 0

    play(scenario)
