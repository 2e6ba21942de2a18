"""Each page is told its own: who it is, what it looks at, and how fast its link is."""

import asyncio
import contextlib
import json
from collections.abc import Awaitable, Callable

import numpy as np
from anyio.from_thread import start_blocking_portal

from mjdrive.page import wire
from mjdrive.web.hub import POSES_WHILE_HIDDEN, Hub
from mjdrive.web.outbox import MOST_TEXTS, Outbox
from mjdrive.web.roles import Standing


class Page:
    """A page that notes what it gets, and its outbox."""

    def __init__(self, hub: Hub) -> None:
        self.got: list[bytes] = []
        self.heard: list[str] = []
        self.outbox = Outbox(self._look, self._listen)
        hub.add(self.outbox)

    async def _look(self, message: bytes) -> None:
        self.got.append(message)

    async def _listen(self, message: str) -> None:
        self.heard.append(message)

    async def pumped(self) -> None:
        """Get all that waits."""
        pump = asyncio.create_task(self.outbox.pump())
        await asyncio.sleep(0.02)
        pump.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await pump


def play(scenario: Callable[[Hub], Awaitable[None]]) -> None:
    """Play it in a thread of its own: in this one a browser's loop may run."""

    async def attached() -> None:
        hub = Hub()
        hub.attach(asyncio.get_running_loop())
        await scenario(hub)

    with start_blocking_portal() as portal:
        portal.call(attached)


def test_each_page_is_told_who_it_is_and_who_drives() -> None:
    async def scenario(hub: Hub) -> None:
        pages = [Page(hub) for _ in range(3)]
        a, _, c = (it.outbox for it in pages)
        hub.tell_state({"paused": False}, Standing(a, (c,), a))
        for page in pages:
            await page.pumped()
        told = [json.loads(page.heard[-1]) for page in pages]
        assert [it["you"] for it in told] == [1, 2, 3]
        assert {(it["operator"], it["driver"], *it["asking"]) for it in told} == {(1, 1, 3)}
        assert [it["wheel"] for it in told] == ["yours", "taken", "taken"]
        hub.tell_state({}, Standing())
        await pages[1].pumped()
        free = json.loads(pages[1].heard[-1])
        assert (free["operator"], free["driver"], free["wheel"]) == (0, 0, "free")

    play(scenario)


def test_numbers_of_pages_are_not_used_again() -> None:
    async def scenario(hub: Hub) -> None:
        first = Page(hub)
        hub.remove(first.outbox)
        assert Page(hub).outbox.number == 2

    play(scenario)


def test_only_pages_behind_a_slow_link_get_views_deflated() -> None:
    async def scenario(hub: Hub) -> None:
        fast, slow = Page(hub), Page(hub)
        slow.outbox.slow = True
        bev = np.zeros((5, 192, 192), np.uint8)
        message = wire.pack("panel", {}, {"bev": bev})
        hub.tell("panel", message)
        await fast.pumped()
        await slow.pumped()
        assert fast.got == [message]
        assert 10 * len(slow.got[0]) < len(message)
        np.testing.assert_array_equal(wire.unpack(slow.got[0])[1]["bev"], bev)

    play(scenario)


def test_hidden_pages_get_few_poses_and_no_panels_but_every_beat() -> None:
    async def scenario(hub: Hub) -> None:
        page = Page(hub)
        page.outbox.hidden = True
        assert not hub.is_watching
        for number in range(2 * POSES_WHILE_HIDDEN):
            hub.tell("pose", str(number).encode())
            hub.tell("panel", b"panel")
            await asyncio.sleep(0)
            await asyncio.sleep(0)
        heart = asyncio.create_task(hub.beat())
        await page.pumped()
        heart.cancel()
        assert len(page.got) == 2
        assert wire.unpack(page.got[1])[0]["k"] == "beat"

    play(scenario)


def test_a_line_for_one_page_is_told_to_no_other() -> None:
    async def scenario(hub: Hub) -> None:
        one, other = Page(hub), Page(hub)
        hub.note("for you", to=one.outbox)
        await one.pumped()
        await other.pumped()
        assert [json.loads(it)["line"] for it in one.heard] == ["for you"]
        assert other.heard == []

    play(scenario)


def test_what_waits_for_a_page_that_does_not_listen_is_bounded() -> None:
    async def scenario(hub: Hub) -> None:
        page = Page(hub)
        for number in range(10 * MOST_TEXTS):
            hub.note(str(number))
        await page.pumped()
        lines = [json.loads(it)["line"] for it in page.heard]
        assert lines == [str(number) for number in range(9 * MOST_TEXTS, 10 * MOST_TEXTS)]

    play(scenario)


def test_a_page_hears_at_once_that_its_slow_link_was_understood() -> None:
    async def scenario(hub: Hub) -> None:
        fast, slow = Page(hub), Page(hub)
        hub.set_slow(slow.outbox, is_slow=True)  # nothing is known yet that could be told
        hub.tell_state({"paused": True}, Standing())
        hub.set_slow(slow.outbox, is_slow=False)
        for page in (fast, slow):
            await page.pumped()
        told = [json.loads(page.heard[-1]) for page in (fast, slow)]
        assert [(it["link"], it["paused"]) for it in told] == [("full", True)] * 2
        hub.set_slow(slow.outbox, is_slow=True)
        await slow.pumped()
        assert json.loads(slow.heard[-1])["link"] == "slow"

    play(scenario)
