"""A LeRobotDataset, read back by pyarrow, by PyAV and by Rerun's reader of LeRobot data sets."""

import dataclasses
import json
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path

import av
import numpy as np
import pyarrow.parquet as pq
import pytest
from rerun.experimental import LeRobotReader

from mjdrive.bev.picture import picture
from mjdrive.config import BevConfig
from mjdrive.episodes.views import states
from mjdrive.errors import DataError
from mjdrive.exchange import lerobot
from mjdrive.exchange.lerobot_tables import BEV, NUMBERS
from mjdrive.exchange.sources import Recording
from mjdrive.exchange.views import ViewMaker
from mjdrive.recording.playback import car_of, town_of


@pytest.fixture(scope="module")
def folder(exported: Callable[[str], Path]) -> Path:
    return exported("lerobot")


def test_another_projects_reader_finds_every_row_of_every_feature(
    folder: Path, recordings: list[Recording]
) -> None:
    reader = LeRobotReader(folder)
    assert (reader.version, reader.episodes()) == ("v3", [0, 1])
    steps = len(recordings[1].episode.time)
    rows: dict[str, int] = defaultdict(int)
    for chunk in reader.stream(1):
        if not chunk.is_static:
            rows[str(chunk.entity_path).lstrip("/")] += chunk.num_rows
    assert {name: rows[name] for name in NUMBERS} == dict.fromkeys(NUMBERS, steps)
    assert rows[BEV] >= steps


def test_rows_are_the_steps_of_the_episodes(folder: Path, recordings: list[Recording]) -> None:
    table = pq.read_table(folder / "data/chunk-000/file-001.parquet")
    episode = recordings[1].episode
    assert table["index"].to_pylist() == list(range(15, 30))
    assert set(table["episode_index"].to_pylist()) == {1}
    np.testing.assert_allclose(table["timestamp"].to_pylist(), episode.time, atol=1e-6)
    for name, meant in (
        ("observation.state", states(episode)),
        ("action", episode.labels),
        ("action.driven", episode.actions),
        ("vehicle", episode.vehicle),
    ):
        np.testing.assert_array_equal(table[name].to_pylist(), meant.astype(np.float32))


def test_the_video_shows_what_was_seen_step_by_step(
    folder: Path, recordings: list[Recording]
) -> None:
    episode = recordings[0].episode
    views, parameters = ViewMaker(town_of(episode)), car_of(episode).parameters
    with av.open(str(folder / f"videos/{BEV}/chunk-000/file-000.mp4")) as video:
        frames = [frame.to_ndarray(format="rgb24") for frame in video.decode(video=0)]
    assert len(frames) == len(episode.time)
    for step in (0, 14):
        meant = picture(views.bev(episode, step), BevConfig(), parameters, scale=1)
        assert np.abs(frames[step].astype(float) - meant).mean() < 4.0


def test_descriptions_agree_with_the_rows(folder: Path) -> None:
    info = json.loads((folder / "meta/info.json").read_text())
    statistics = json.loads((folder / "meta/stats.json").read_text())
    table = pq.read_table(folder / "data/chunk-000/file-000.parquet")
    assert (info["codebase_version"], info["total_frames"], info["fps"]) == ("v3.0", 30, 10)
    assert set(info["features"]) == {*table.column_names, BEV} == set(statistics)
    episodes = pq.read_table(folder / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
    spans = [(it["dataset_from_index"], it["dataset_to_index"]) for it in episodes]
    assert spans == [(0, 15), (15, 30)]
    for it in episodes:
        index = {"chunk_index": it["data/chunk_index"], "file_index": it["data/file_index"]}
        assert (folder / info["data_path"].format(**index)).is_file()
        assert (folder / info["video_path"].format(video_key=BEV, **index)).is_file()
    tasks = pq.read_table(folder / "meta/tasks.parquet")
    about = json.loads(tasks.schema.metadata[b"pandas"])
    assert tasks[about["index_columns"][0]].to_pylist() == episodes[0]["tasks"]


def test_steps_that_are_not_even_are_refused(tmp_path: Path, recordings: list[Recording]) -> None:
    episode = recordings[1].episode
    odd = dataclasses.replace(episode, time=2 * episode.time)
    with pytest.raises(DataError, match=r"steps of 0\.2 to 0\.2 s"):
        lerobot.write([Recording("odd", odd)], tmp_path, on_step=lambda done: None)
    assert not list(tmp_path.iterdir())
