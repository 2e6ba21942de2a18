"""What a page can ask for over HTTP: lists, the scene, and episodes to replay."""

from collections.abc import Awaitable, Callable
from functools import lru_cache
from urllib.parse import quote

import anyio.to_thread
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Route

from mjdrive.datatypes import Episode, Town
from mjdrive.errors import MjdriveError, UnknownNameError
from mjdrive.page import wire
from mjdrive.page.replaying import episode_message, view_at
from mjdrive.page.scene import scene_message
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from mjdrive.web.browsing import Shelf
from mjdrive.web.choices import policy_names
from mjdrive.web.simulator import Simulator

BINARY = "application/octet-stream"
Answer = Callable[[Request], Awaitable[Response]]


class Api:
    """Answers of the server besides the socket.

    Args:
        simulator: What is driven.
        shelf: The folders that pages may look into.
    """

    def __init__(self, simulator: Simulator, shelf: Shelf) -> None:
        self._simulator, self._shelf = simulator, shelf
        self._episode = lru_cache(maxsize=2)(shelf.episode)

    def routes(self) -> list[Route]:
        """Say which address answers what; what changes anything must be posted."""
        return [
            Route("/api/health", self.health),
            Route("/api/catalogue", self.catalogue),
            Route("/api/scene", self.scene),
            Route("/api/episodes", _apart(self._shelf.episodes)),
            Route("/api/runs", _apart(self._shelf.run_list)),
            Route("/api/drives", _apart(self._shelf.drive_figures)),
            Route("/api/episode", self.episode),
            Route("/api/episode/view", self.view),
            Route("/api/episode/file", self.file),
            Route("/api/episode/delete", self.delete, methods=["POST"]),
        ]

    async def health(self, request: Request) -> Response:
        """Whether it drives, and how far it has come: for scripts and benchmarks."""
        del request
        cockpit = self._simulator.cockpit
        done = {"steps": cockpit.num_steps, "busy": self._simulator.busy}
        how = {"paused": cockpit.is_paused, "fault": cockpit.fault}
        return JSONResponse({"v": wire.VERSION, **done, **how})

    async def catalogue(self, request: Request) -> Response:
        """Towns and policies that can be chosen."""
        del request
        names = policy_names(self._shelf.runs)
        return JSONResponse({"v": wire.VERSION, "towns": library.town_names(), "policies": names})

    async def scene(self, request: Request) -> Response:
        """The town that is driven, or another one by its name, to replay in it what others do not watch."""
        session = self._simulator.session
        name = request.query_params.get("town", session.choice.town)
        if name != session.choice.town:
            return await _binary(lambda: _scene(name))
        # With the name, which is in the scene and not in the digest: a folder may be a copy of another.
        tag = f'"{quote(name)}-{session.simulation.town.digest[:16]}-{wire.VERSION}"'
        headers = {"etag": tag, "cache-control": "no-cache"}
        if request.headers.get("if-none-match") == tag:
            return Response(status_code=304, headers=headers)
        return Response(session.scene, media_type=BINARY, headers=headers)

    async def episode(self, request: Request) -> Response:
        """One episode to replay."""
        name = request.query_params.get("name", "")
        return await _binary(lambda: episode_message(self._episode(name), name))

    async def view(self, request: Request) -> Response:
        """What the policy saw at one step of an episode."""
        name, step = request.query_params.get("name", ""), request.query_params.get("step", "")
        if not step.isdecimal():
            return _refused("Expected step=N, a control step of the episode.")
        return await _binary(lambda: _view(self._episode(name), int(step)))

    async def file(self, request: Request) -> Response:
        """The file of one episode, to take away."""
        name = request.query_params.get("name", "")
        try:
            path = await anyio.to_thread.run_sync(self._shelf.file, name)
        except MjdriveError as error:
            return _refused(str(error))
        return FileResponse(path, media_type=BINARY, filename=f"{name.replace('/', '-')}.hdf5")

    async def delete(self, request: Request) -> Response:
        """Delete one drive."""
        try:
            await anyio.to_thread.run_sync(self._shelf.delete, request.query_params.get("name", ""))
        except MjdriveError as error:
            return _refused(str(error))
        self._episode.cache_clear()
        return JSONResponse({"deleted": True})


def _view(episode: Episode, step: int) -> bytes:
    at = min(step, len(episode.time) - 1)
    return wire.pack("view", {"step": at}, {"bev": view_at(episode, at)})


def _scene(name: str) -> bytes:
    """Describe a town that nobody drives in now, as it is by now.

    Raises:
        UnknownNameError: If there is no such town.
    """
    names = library.town_names()
    if name not in names:
        raise UnknownNameError("town", name, names)
    return _scene_of(library.load(name))


@lru_cache(maxsize=2)
def _scene_of(town: Town) -> bytes:
    return scene_message(town, Simulation(town).model)


def _apart(listing: Callable[[], list[dict[str, object]]]) -> Answer:
    """Answer with a list that is made in another thread."""

    async def answer(request: Request) -> Response:
        del request
        try:
            return JSONResponse(await anyio.to_thread.run_sync(listing))
        except MjdriveError as error:
            return _refused(str(error))

    return answer


async def _binary(make: Callable[[], bytes]) -> Response:
    try:
        return Response(await anyio.to_thread.run_sync(make), media_type=BINARY)
    except MjdriveError as error:
        return _refused(str(error))


def _refused(reason: str) -> Response:
    return JSONResponse({"error": reason}, 400)
