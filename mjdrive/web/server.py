"""The application: one socket a page, the built page itself, and the answers of `Api`."""

import asyncio
import contextlib
from collections.abc import AsyncIterator
from pathlib import Path

import anyio
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Mount, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp
from starlette.websockets import WebSocket, WebSocketDisconnect

from mjdrive.page import built, wire
from mjdrive.web.api import Api
from mjdrive.web.browsing import Shelf
from mjdrive.web.commands import CommandError, parse
from mjdrive.web.guard import Access, Guard
from mjdrive.web.hub import Hub
from mjdrive.web.outbox import Outbox
from mjdrive.web.session import Session
from mjdrive.web.simulator import Simulator

MOST_PAGES = 8

MOST_SILENCE = 90.0
"""A page that acknowledges nothing for so long is frozen or gone, and takes up a place [s]."""

TRY_LATER = 1013
NOT_UNDERSTOOD = 1003
GOING_AWAY = 1001


def make_app(
    session: Session, *, shelf: Shelf, access: Access, page: Path = built.FOLDER
) -> ASGIApp:
    """Make the application; it drives while it runs.

    Args:
        session: What is driven.
        shelf: The folders that pages may look into.
        access: Who may talk to it.
        page: The built page.

    Raises:
        RenderError: If the page was never built.
    """
    built.require_built(page)
    hub = Hub()
    simulator = Simulator(session, hub)

    @contextlib.asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[None]:
        del app
        hub.attach(asyncio.get_running_loop())
        simulator.start()
        heart = asyncio.create_task(hub.beat())
        yield
        heart.cancel()
        await asyncio.to_thread(simulator.stop)

    async def socket(websocket: WebSocket) -> None:
        await _serve(websocket, hub, simulator)

    app = Starlette(
        routes=[
            *Api(simulator, shelf).routes(),
            WebSocketRoute("/ws", socket),
            Mount("/", StaticFiles(directory=page, html=True)),
        ],
        lifespan=lifespan,
        exception_handlers={Exception: _failed},
    )
    return Guard(app, access)


async def _failed(request: Request, error: Exception) -> Response:
    """Say in the page that something of ours has failed; the traceback is in the terminal."""
    words = f"{request.url.path} failed: {type(error).__name__}: {error}. The terminal tells more."
    return JSONResponse({"error": words}, 500)


async def _serve(websocket: WebSocket, hub: Hub, simulator: Simulator) -> None:
    """Talk to one page until it goes."""
    await websocket.accept()
    if len(hub.pages) >= MOST_PAGES:
        await websocket.close(TRY_LATER, f"{MOST_PAGES} pages are open already.")
        return
    outbox = Outbox(websocket.send_bytes, websocket.send_text)
    hub.add(outbox)
    pump = asyncio.create_task(outbox.pump())
    simulator.inbox.come(outbox)
    try:
        while True:
            message = await asyncio.wait_for(websocket.receive_text(), MOST_SILENCE)
            _hear(message, outbox, hub, simulator)
    except TimeoutError:
        with contextlib.suppress(RuntimeError):  # it has gone
            reason = f"The page said nothing for {MOST_SILENCE:.0f} s."
            await websocket.close(GOING_AWAY, reason)
    except CommandError as error:
        with contextlib.suppress(RuntimeError):  # it has gone
            await websocket.send_text(wire.text("note", {"line": str(error), "error": True}))
            await websocket.close(NOT_UNDERSTOOD)
    except (WebSocketDisconnect, KeyError):  # KeyError: a binary message
        pass
    finally:
        hub.remove(outbox)
        simulator.inbox.leave(outbox)
        pump.cancel()
        with anyio.CancelScope(shield=True):  # who ends us must not end this, too
            await asyncio.gather(pump, return_exceptions=True)  # it may have met the end before us


def _hear(message: str, outbox: Outbox, hub: Hub, simulator: Simulator) -> None:
    """Obey one message of a page.

    Raises:
        CommandError: If it means nothing.
    """
    command = parse(message)
    if command.op == "ack":
        outbox.acknowledge(command.values["n"])
    elif command.op == "hidden":
        outbox.hidden = command.values["on"]
    elif command.op == "slow":
        hub.set_slow(outbox, command.values["on"])
    elif not simulator.inbox.put(command, outbox):
        busy = {"line": "The simulator is busy; that was not heard.", "error": True}
        outbox.put_text("busy", wire.text("note", busy))
