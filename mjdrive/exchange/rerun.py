"""A drive -> an .rrd file, which the viewer of Rerun opens.

    town/lanes        LineStrips3D   edges of all lanes, for all time
    car               Transform3D    world -> car (rear axle); car/body is a box
    path              LineStrips3D   the whole way, for all time
    view              EncodedImage   bird's-eye view, coloured, car looking up
    speed             Scalars        [m/s]
    acceleration      Scalars        driven [-]
    steering          Scalars        driven, positive to the left [-]
    infractions       TextLog        what the rules hold against the drive

The timeline "time" is that of the simulation, from 0 [s].
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import rerun as rr

from mjdrive.datatypes import Episode, Town
from mjdrive.evaluation.figure_style import SYMBOLS
from mjdrive.exchange.sources import Recording
from mjdrive.exchange.views import ViewMaker
from mjdrive.recording.playback import car_of, town_of
from mjdrive.town.surface import edges
from mjdrive.vehicle.parameters import VehicleParameters

TIMELINE = "time"
HEIGHT = 1.45  # of the box that stands for the car [m]
GREY, BLUE = (140, 149, 159), (9, 105, 218)


def write(recording: Recording, path: Path, *, on_step: Callable[[int], None]) -> None:
    """Write one drive.

    Raises:
        DataError: If town or car are not those of the episode.
    """
    episode = recording.episode
    town, parameters = town_of(episode), car_of(episode, name=recording.car).parameters
    stream = rr.RecordingStream("mjdrive", recording_id=recording.name)
    stream.save(path)
    stream.send_recording_name(f"{recording.name}: {episode.policy} in {episode.town}")
    _log_what_stays(stream, episode, town, parameters)
    _log_columns(stream, episode)
    views = ViewMaker(town)
    for step, now in enumerate(episode.time.tolist()):
        stream.set_time(TIMELINE, duration=now)
        png = views.png(episode, step, parameters)
        stream.log("view", rr.EncodedImage(contents=png, media_type="image/png"))
        on_step(step + 1)
    for it in episode.infractions:
        stream.set_time(TIMELINE, duration=it.time)
        told = f"{SYMBOLS[it.kind][0]}: {it.cause} at ({it.x:.1f}, {it.y:.1f}) m"
        stream.log("infractions", rr.TextLog(told, level=rr.TextLogLevel.ERROR))
    stream.disconnect()  # which waits until all is written


def _log_what_stays(
    stream: rr.RecordingStream, episode: Episode, town: Town, parameters: VehicleParameters
) -> None:
    strips = [_on_ground(edge) for lane in town.lanes.values() for edge in edges(lane)]
    stream.log("town/lanes", rr.LineStrips3D(strips, colors=GREY), static=True)
    path = [_on_ground(episode.vehicle[:, :2])]
    stream.log("path", rr.LineStrips3D(path, colors=BLUE), static=True)
    middle = parameters.length / 2 - parameters.rear_overhang
    half = (parameters.length / 2, parameters.width / 2, HEIGHT / 2)
    body = rr.Boxes3D(centers=[(middle, 0.0, HEIGHT / 2)], half_sizes=[half], colors=BLUE)
    stream.log("car/body", body, static=True)


def _log_columns(stream: rr.RecordingStream, episode: Episode) -> None:
    """What has one value a step goes in whole columns, which takes hundreds of times less."""
    times = [rr.TimeColumn(TIMELINE, duration=episode.time)]
    for name, values in (
        ("speed", episode.vehicle[:, 3]),
        ("acceleration", episode.actions[:, 0]),
        ("steering", episode.actions[:, 1]),
    ):
        stream.send_columns(name, indexes=times, columns=rr.Scalars.columns(scalars=values))
    zero, yaw = np.zeros(len(episode.time)), episode.vehicle[:, 2]
    places = _on_ground(episode.vehicle[:, :2])
    turns = np.stack([zero, zero, np.sin(yaw / 2), np.cos(yaw / 2)], axis=1)
    poses = rr.Transform3D.columns(translation=places, quaternion=turns)
    stream.send_columns("car", indexes=times, columns=poses)


def _on_ground(points: np.ndarray) -> np.ndarray:
    return np.column_stack([points, np.zeros(len(points))])
