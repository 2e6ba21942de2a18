"""A LeRobotDataset, read back by LeRobot itself: every row and every picture."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from mjdrive.bev.picture import picture
from mjdrive.config import BevConfig
from mjdrive.episodes.views import states
from mjdrive.exchange.lerobot_tables import BEV, NUMBERS
from mjdrive.exchange.sources import Recording
from mjdrive.exchange.views import ViewMaker
from mjdrive.recording.playback import car_of, town_of

READER = Path(sys.prefix) / "lerobot"
"""A folder of its own, which `make install` fills: LeRobot asks for an older torch, and works with ours."""

# LeRobot asks of torchvision its transforms and its reader of videos. Built for another torch, it cannot load its operators,
# and breaks where it describes this one unless somebody has said what it looks like.
PROGRAM = f"""
import sys, warnings
import numpy as np
import torch
warnings.simplefilter("ignore")
operators = torch.library.Library("torchvision", "DEF")
operators.define("nms(Tensor dets, Tensor scores, float iou_threshold) -> Tensor")
from lerobot.datasets.lerobot_dataset import LeRobotDataset
dataset = LeRobotDataset("mjdrive/drives", root=sys.argv[1], video_backend="pyav")
rows = [dataset[index] for index in range(len(dataset))]
names = ({BEV!r}, *{tuple(NUMBERS)!r}, "timestamp", "episode_index", "frame_index")
found = {{name: np.stack([row[name].numpy() for row in rows]) for name in names}}
mean = dataset.meta.stats["vehicle"]["mean"]
tasks = sorted({{row["task"] for row in rows}})
np.savez(sys.argv[2], tasks=tasks, fps=dataset.fps, episodes=dataset.num_episodes, mean=mean, **found)
"""


@pytest.fixture(scope="module")
def read(
    exported: Callable[[str], Path], tmp_path_factory: pytest.TempPathFactory
) -> dict[str, np.ndarray]:
    """What LeRobot makes of an export."""
    if not READER.exists():
        pytest.skip("LeRobot's reader is not there; see `make install`")
    folder = tmp_path_factory.mktemp("lerobot")
    quiet = {"HF_HUB_OFFLINE": "1", "HF_HOME": str(folder), "PYTHONPATH": str(READER)}
    command = [sys.executable, "-c", PROGRAM, str(exported("lerobot")), str(folder / "read.npz")]
    done = subprocess.run(
        command, env={**os.environ, **quiet}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    with np.load(folder / "read.npz") as file:
        return dict(file)


def test_lerobot_finds_every_row_of_every_episode(
    read: dict[str, np.ndarray], recordings: list[Recording]
) -> None:
    assert (int(read["fps"]), int(read["episodes"]), len(read["tasks"])) == (10, 2, 1)
    assert "town02" in str(read["tasks"][0])
    for index, it in enumerate(recordings):
        rows = read["episode_index"] == index
        np.testing.assert_array_equal(read["frame_index"][rows], np.arange(len(it.episode.time)))
        np.testing.assert_allclose(read["timestamp"][rows], it.episode.time, atol=1e-6)
        for name, meant in (
            ("observation.state", states(it.episode)),
            ("action", it.episode.labels),
            ("action.driven", it.episode.actions),
            ("vehicle", it.episode.vehicle),
        ):
            np.testing.assert_array_equal(read[name][rows], meant.astype(np.float32))
    np.testing.assert_allclose(read["mean"], read["vehicle"].mean(axis=0), rtol=1e-4, atol=1e-4)


def test_lerobot_decodes_the_picture_of_every_row(
    read: dict[str, np.ndarray], recordings: list[Recording]
) -> None:
    start = 0
    for it in recordings:
        views, parameters = ViewMaker(town_of(it.episode)), car_of(it.episode).parameters
        for step in range(len(it.episode.time)):
            seen = 255.0 * read[BEV][start + step].transpose(1, 2, 0)
            meant = picture(views.bev(it.episode, step), BevConfig(), parameters, scale=1)
            assert np.abs(seen - meant).mean() < 4.0, f"{it.name}, step {step}"
        start += len(it.episode.time)
