"""Drives -> a LeRobotDataset v3 (Hugging Face LeRobot): parquet, one mp4 an episode, JSON.

meta/info.json, stats.json, tasks.parquet, episodes/chunk-000/file-000.parquet
data/chunk-000/file-<i>.parquet      one row a step of episode i
videos/observation.images.bev/chunk-000/file-<i>.mp4

observation.state        (3,)           speed [m/s], previous acceleration and steering [-]
observation.images.bev   (192, 192, 3)  bird's-eye view, coloured, car looking up; H.264, so nearly what the policy saw
action                   (2,)           what the policy wanted: acceleration and steering [-]
action.driven            (2,)           what was driven, which a disturbance may have changed [-]
vehicle                  (6,)           `Episode.vehicle`
"""

import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from jaxtyping import UInt8

from mjdrive.bev.picture import picture
from mjdrive.config import BevConfig
from mjdrive.datatypes import Episode
from mjdrive.episodes.views import states
from mjdrive.errors import DataError
from mjdrive.exchange import lerobot_tables
from mjdrive.exchange.lerobot_tables import BEV, FILES_A_CHUNK, FPS, Part, Table
from mjdrive.exchange.sources import Recording
from mjdrive.exchange.views import ViewMaker
from mjdrive.recording import mp4
from mjdrive.recording.playback import car_of, town_of


def write(recordings: Sequence[Recording], folder: Path, *, on_step: Callable[[int], None]) -> None:
    """Write drives as one data set.

    Raises:
        DataError: If a drive has not ten steps a second, or a town or car is not that of its episode.
    """
    for it in recordings:
        _require_even(it)
    tasks = list(dict.fromkeys(_task(it.episode) for it in recordings))
    parts: list[Part] = []
    columns: list[Table] = []
    for index, it in enumerate(recordings):
        before = sum(part.steps for part in parts)
        table = _columns(it.episode, index, before, tasks.index(_task(it.episode)))
        _write_table(table, folder / _place("data", index, "parquet"))
        moments = _write_video(it, folder / _place(f"videos/{BEV}", index, "mp4"), before, on_step)
        parts.append(Part(len(it.episode.time), _task(it.episode), moments))
        columns.append(table)
    _write_table(
        lerobot_tables.episodes(parts), folder / "meta/episodes/chunk-000/file-000.parquet"
    )
    lerobot_tables.write_tasks(tasks, folder / "meta/tasks.parquet")
    _write_json(lerobot_tables.info(parts, tasks), folder / "meta/info.json")
    _write_json(lerobot_tables.statistics(parts, columns), folder / "meta/stats.json")


def _require_even(recording: Recording) -> None:
    steps = np.diff(recording.episode.time)
    if len(steps) and np.abs(steps - 1 / FPS).max() > 1e-6:
        raise DataError(
            f"The drive '{recording.name}' has steps of {steps.min():g} to {steps.max():g} s; LeRobot wants even ones, and ours "
            f"are {1 / FPS:g} s."
        )


def _task(episode: Episode) -> str:
    return f"Drive through {episode.town} and keep the rules of the road."


def _place(kind: str, index: int, suffix: str) -> str:
    chunk, file = divmod(index, FILES_A_CHUNK)
    return f"{kind}/chunk-{chunk:03d}/file-{file:03d}.{suffix}"


def _columns(episode: Episode, index: int, before: int, task: int) -> Table:
    """The rows of one episode."""
    count = np.arange(len(episode.time))
    values = {
        "observation.state": states(episode),
        "action": episode.labels,
        "action.driven": episode.actions,
        "vehicle": episode.vehicle,
    }
    return {
        **{name: value.astype(np.float32) for name, value in values.items()},
        "timestamp": (count / FPS).astype(np.float32),
        "frame_index": count,
        "episode_index": np.full(len(count), index),
        "index": before + count,
        "task_index": np.full(len(count), task),
    }


def _write_video(
    recording: Recording, path: Path, before: int, on_step: Callable[[int], None]
) -> np.ndarray:
    """Write what was seen; returns the moments of its colours."""
    episode = recording.episode
    views, parameters = ViewMaker(town_of(episode)), car_of(episode, name=recording.car).parameters
    moments = np.array([[np.inf] * 3, [-np.inf] * 3, [0.0] * 3, [0.0] * 3])

    def frames() -> Iterator[UInt8[np.ndarray, "H W 3"]]:
        for step in range(len(episode.time)):
            frame = picture(views.bev(episode, step), BevConfig(), parameters, scale=1)
            colours = frame.reshape(-1, 3) / 255.0
            moments[0] = np.minimum(moments[0], colours.min(axis=0))
            moments[1] = np.maximum(moments[1], colours.max(axis=0))
            moments[2] += colours.mean(axis=0)
            moments[3] += (colours**2).mean(axis=0)
            yield frame
            on_step(before + step + 1)

    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(mp4.encode(frames(), frames_per_second=FPS, for_jumps=True))
    return moments


def _write_table(columns: Table, path: Path) -> None:
    arrays = {}
    for name, values in columns.items():
        if isinstance(values, np.ndarray) and values.ndim == 2:
            flat = pa.array(values.ravel())
            arrays[name] = pa.FixedSizeListArray.from_arrays(flat, values.shape[1])
        else:
            arrays[name] = pa.array(values)
    path.parent.mkdir(parents=True, exist_ok=True)
    pq.write_table(pa.table(arrays), path)


def _write_json(content: dict[str, Any], path: Path) -> None:
    path.write_text(json.dumps(content, indent=4) + "\n")
