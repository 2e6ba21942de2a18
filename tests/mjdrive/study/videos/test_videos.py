"""A video is kept as long as it shows what is there."""

import dataclasses
from pathlib import Path

import pytest

from mjdrive.datatypes import Town
from mjdrive.study.records.results import Turn
from mjdrive.study.videos import videos
from mjdrive.study.videos.videos import video_file, write_videos
from mjdrive.town import library
from models import presets
from models.learners import build_learner

TURN = Turn("da-ibc", 0, "approach", "exit", "left", "turn.hdf5")


def test_a_video_of_other_weights_or_turns_is_made_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = []

    def pretend(drives: object, learner: object, town: Town, path: Path, *, title: str) -> None:
        made.append(title)
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(b"film")

    monkeypatch.setattr(videos, "write_turns", pretend)
    monkeypatch.setattr("mjdrive.episodes.store.read", lambda path: None)
    learner, town = build_learner(presets.quick("bc-beta"), seed=0), library.load("town02")

    def count(weights: str, turn: Turn = TURN) -> int:
        before = len(made)
        labels = {"da-ibc": "DA-IBC"}
        write_videos(
            [turn], lambda *_: learner, labels, town, tmp_path, weights_of=lambda *_: weights
        )
        return len(made) - before

    (tmp_path / TURN.file).write_bytes(b"drive")
    assert (count("ab"), count("ab")) == (1, 0)
    assert (count("cd"), count("cd")) == (1, 0)
    (tmp_path / TURN.file).write_bytes(b"another drive")
    assert (count("cd"), count("cd")) == (1, 0)
    assert (count("cd", dataclasses.replace(TURN, move="right")), count("cd")) == (1, 1)
    (tmp_path / video_file("da-ibc", 0)).unlink()
    assert count("cd") == 1
