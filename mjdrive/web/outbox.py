"""What waits to be sent to one page: at most one message of a kind, so that a slow page loses pictures and never sees old ones.

TCP would queue seconds of them. So the page says how many it has handled, and no more than `WINDOW` are on their way.
"""

import asyncio
from collections.abc import Awaitable, Callable

WINDOW = 6
"""Messages that a page may have unacknowledged [-]."""

BEGINNING = "history"
"""The kind after which all is told anew; what waited before it belongs to another drive."""

MOST_TEXTS = 32
"""That wait; the oldest are forgotten [-]."""

Send = Callable[[bytes], Awaitable[None]]
SendText = Callable[[str], Awaitable[None]]


class Outbox:
    """The messages of one page; used in the event loop alone.

    Args:
        send: Sends a binary message.
        send_text: Sends a text message.

    Attributes:
        sent: Binary messages sent [-].
        acknowledged: Of these, how many the page has handled [-].
        dropped: Messages that newer ones of their kind took the place of [-].
        hidden: Whether nobody looks at the page.
        slow: Whether its link is slow.
        number: How people call the page; 0 before it has one [-].
    """

    def __init__(self, send: Send, send_text: SendText) -> None:
        self._send, self._send_text = send, send_text
        self._waiting: dict[str, bytes] = {}
        self._texts: dict[str, str] = {}
        self._ready = asyncio.Event()
        self.sent = self.acknowledged = self.dropped = 0
        self.hidden = self.slow = False
        self.number = 0

    def put(self, kind: str, message: bytes) -> None:
        """Let a message wait; an older one of its kind is forgotten, and all that came before a `BEGINNING`."""
        if kind == BEGINNING:
            self.dropped += len(self._waiting)
            self._waiting.clear()
        self.dropped += kind in self._waiting
        self._waiting[kind] = message
        self._ready.set()

    def put_text(self, kind: str, message: str) -> None:
        """Let a text message wait; those are few, and go first."""
        self._texts[kind] = message
        if len(self._texts) > MOST_TEXTS:
            del self._texts[next(iter(self._texts))]
        self._ready.set()

    def acknowledge(self, count: int) -> None:
        """Hear how many binary messages the page has handled; nobody handles more than were sent."""
        self.acknowledged = max(self.acknowledged, min(count, self.sent))
        self._ready.set()

    async def pump(self) -> None:
        """Send what waits, for ever."""
        while True:
            await self._ready.wait()
            self._ready.clear()
            while self._texts:
                await self._send_text(self._texts.pop(next(iter(self._texts))))
            while self._waiting and self.sent - self.acknowledged < WINDOW:
                kind = next(iter(self._waiting))
                message = self._waiting.pop(kind)
                self.sent += 1
                await self._send(message)
