"""What a LeRobotDataset says about itself: features, where each episode is, tasks, statistics."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from mjdrive.config import BevConfig

VERSION = "v3.0"
FPS = 10
"""Steps and frames a second; LeRobot wants them even [1/s]."""

BEV = "observation.images.bev"
FILES_A_CHUNK = 1000
"""LeRobot's own limit [-]."""

NUMBERS = {
    "observation.state": ("speed", "previous_acceleration", "previous_steering"),
    "action": ("acceleration", "steering"),
    "action.driven": ("acceleration", "steering"),
    "vehicle": ("x", "y", "yaw", "speed", "yaw_rate", "steering_angle"),
}
"""Features that are vectors, and what their components are called."""

COUNTERS = ("frame_index", "episode_index", "index", "task_index")

Table = dict[str, Any]
"""Columns by name."""


class Part(NamedTuple):
    """One episode, as it was written.

    Attributes:
        steps: Rows [-].
        task: In words.
        moments: Least, greatest, sum and sum of squares of the colours of its views, shape (4, 3) [-].
    """

    steps: int
    task: str
    moments: np.ndarray


def episodes(parts: Sequence[Part]) -> Table:
    """One row an episode: where its rows and its video are."""
    count = np.arange(len(parts))
    ends = np.cumsum([part.steps for part in parts])
    steps = np.array([part.steps for part in parts])
    chunks, files = np.divmod(count, FILES_A_CHUNK)
    video = f"videos/{BEV}"
    return {
        "episode_index": count,
        "tasks": [[part.task] for part in parts],
        "length": steps,
        "data/chunk_index": chunks,
        "data/file_index": files,
        "dataset_from_index": ends - steps,
        "dataset_to_index": ends,
        f"{video}/chunk_index": chunks,
        f"{video}/file_index": files,
        f"{video}/from_timestamp": np.zeros(len(parts)),
        f"{video}/to_timestamp": steps / FPS,
        "meta/episodes/chunk_index": np.zeros_like(count),
        "meta/episodes/file_index": np.zeros_like(count),
    }


def write_tasks(tasks: list[str], path: Path) -> None:
    """A table whose index, for pandas, is the task in words."""
    index, column = "__index_level_0__", "task_index"
    table = pa.table({column: pa.array(range(len(tasks)), pa.int64()), index: pa.array(tasks)})
    plain = {"metadata": None}
    about = {
        "index_columns": [index],
        "column_indexes": [],
        "columns": [
            {"name": column, "field_name": column, "pandas_type": "int64", "numpy_type": "int64", **plain},
            {"name": None, "field_name": index, "pandas_type": "unicode", "numpy_type": "object", **plain},
        ],
        "pandas_version": "2.0.0",
    }  # fmt: skip
    pq.write_table(table.replace_schema_metadata({"pandas": json.dumps(about)}), path)


def info(parts: Sequence[Part], tasks: Sequence[str]) -> dict[str, Any]:
    """What `meta/info.json` says: how much there is, where it is, and what each feature is."""
    size = BevConfig().size_px
    numbers = {
        name: {"dtype": "float32", "shape": [len(names)], "names": list(names)}
        for name, names in NUMBERS.items()
    }
    single = {"shape": [1], "names": None}
    video = {
        "dtype": "video",
        "shape": [size, size, 3],
        "names": ["height", "width", "channels"],
        "info": {
            "video.height": size,
            "video.width": size,
            "video.codec": "h264",
            "video.pix_fmt": "yuv420p",
            "video.is_depth_map": False,
            "video.fps": FPS,
            "video.channels": 3,
            "has_audio": False,
        },
    }
    counters = {name: {"dtype": "int64", **single} for name in COUNTERS}
    pattern = "chunk-{chunk_index:03d}/file-{file_index:03d}"
    return {
        "codebase_version": VERSION,
        "robot_type": "mjdrive",
        "total_episodes": len(parts),
        "total_frames": sum(part.steps for part in parts),
        "total_tasks": len(tasks),
        "chunks_size": FILES_A_CHUNK,
        "data_files_size_in_mb": 100,
        "video_files_size_in_mb": 200,
        "fps": FPS,
        "splits": {"train": f"0:{len(parts)}"},
        "data_path": f"data/{pattern}.parquet",
        "video_path": f"videos/{{video_key}}/{pattern}.mp4",
        "features": {
            **numbers,
            BEV: video,
            "timestamp": {"dtype": "float32", **single},
            **counters,
        },
    }


def statistics(parts: Sequence[Part], columns: Sequence[Table]) -> dict[str, Any]:
    """Least, greatest, mean, spread and number of every feature, for whoever normalises."""
    total = sum(part.steps for part in parts)
    found = {}
    for name in columns[0]:
        values = np.concatenate([table[name] for table in columns]).reshape(total, -1)
        kinds = {"min": values.min(0), "max": values.max(0), "mean": values.mean(0), "std": values.std(0)}  # fmt: skip
        found[name] = {kind: value.tolist() for kind, value in kinds.items()} | {"count": [total]}
    moments = np.stack([part.moments for part in parts])
    mean = moments[:, 2].sum(axis=0) / total
    spread = np.sqrt(np.maximum(moments[:, 3].sum(axis=0) / total - mean**2, 0.0))
    colours = {"min": moments[:, 0].min(0), "max": moments[:, 1].max(0), "mean": mean, "std": spread}  # fmt: skip
    shaped = {kind: value.reshape(3, 1, 1).tolist() for kind, value in colours.items()}
    return {**found, BEV: {**shaped, "count": [total]}}
