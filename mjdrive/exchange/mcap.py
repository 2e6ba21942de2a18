"""A drive -> an MCAP file, which Foxglove and Lichtblick open.

    /town         foxglove.SceneUpdate       edges of all lanes, once
    /tf           foxglove.FrameTransform    world -> car (rear axle)
    /view         foxglove.CompressedImage   bird's-eye view, coloured, car looking up
    /car          mjdrive.Car                speed, yaw rate, steering angle, actions
    /infractions  foxglove.Log               what the rules hold against the drive

Times are those of the simulation, from 0; the metadata record "episode" holds what `Episode` says of the whole drive.
"""

import base64
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from mcap.writer import Writer

from mjdrive.evaluation.figure_style import SYMBOLS
from mjdrive.exchange import foxglove
from mjdrive.exchange.sources import Recording
from mjdrive.exchange.views import ViewMaker
from mjdrive.recording.playback import car_of, town_of
from mjdrive.town.surface import edges

CAR = "mjdrive.Car"
UNITS = {
    "speed": "m/s",
    "yaw_rate": "rad/s",
    "steering_angle": "rad",
    "acceleration": "-",
    "steering": "-",
    "wanted_acceleration": "-",
    "wanted_steering": "-",
}
"""Fields of a message about the car, and their units."""

TOPICS = {
    "/town": "foxglove.SceneUpdate",
    "/tf": "foxglove.FrameTransform",
    "/view": "foxglove.CompressedImage",
    "/car": CAR,
    "/infractions": "foxglove.Log",
}
"""Kind of the messages of each topic."""

Message = tuple[str, float, dict[str, Any]]
"""Topic, time [s] and content."""


def write(recording: Recording, path: Path, *, on_step: Callable[[int], None]) -> None:
    """Write one drive.

    Raises:
        DataError: If town or car are not those of the episode.
    """
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="", library="mjdrive")
        channels = {
            topic: writer.register_channel(topic, "json", _register(writer, kind))
            for topic, kind in TOPICS.items()
        }
        for topic, time, content in _messages(recording, on_step):
            now = round(time * 1e9)
            writer.add_message(channels[topic], now, json.dumps(content).encode(), now)
        writer.add_metadata("episode", _about(recording))
        writer.finish()  # type: ignore[no-untyped-call]


def _register(writer: Writer, kind: str) -> int:
    numbers = {name: {"type": "number", "description": unit} for name, unit in UNITS.items()}
    properties = numbers if kind == CAR else foxglove.SCHEMAS[kind]
    schema = {"title": kind, "type": "object", "properties": properties}
    return writer.register_schema(kind, "jsonschema", json.dumps(schema).encode())


def _messages(recording: Recording, on_step: Callable[[int], None]) -> Iterator[Message]:
    """All that is told, in the order of time."""
    episode = recording.episode
    town, parameters = town_of(episode), car_of(episode, name=recording.car).parameters
    views, start = ViewMaker(town), float(episode.time[0])
    paths = [edge for lane in town.lanes.values() for edge in edges(lane)]
    yield "/town", start, foxglove.lines(start, town.name, paths)
    open_infractions = list(episode.infractions)
    for step, now in enumerate(episode.time.tolist()):
        while open_infractions and open_infractions[0].time <= now + 1e-9:
            yield _told(open_infractions.pop(0))
        x, y, yaw, *motion = episode.vehicle[step].tolist()
        yield "/tf", now, foxglove.transform(now, x=x, y=y, yaw=yaw)
        values = (*motion, *episode.actions[step].tolist(), *episode.labels[step].tolist())
        yield "/car", now, dict(zip(UNITS, values, strict=True))
        png = base64.b64encode(views.png(episode, step, parameters)).decode()
        yield "/view", now, foxglove.image(now, png)
        on_step(step + 1)
    yield from map(_told, open_infractions)


def _told(it: Any) -> Message:
    words = SYMBOLS[it.kind][0]
    where = f"{words}: {it.cause} at ({it.x:.1f}, {it.y:.1f}) m"
    return "/infractions", it.time, foxglove.log(it.time, where)


def _about(recording: Recording) -> dict[str, str]:
    episode = recording.episode
    return {
        "name": recording.name,
        "town": episode.town,
        "policy": episode.policy,
        "seed": str(episode.seed),
        "light_phase": repr(episode.light_phase),
        **episode.metadata,
    }
