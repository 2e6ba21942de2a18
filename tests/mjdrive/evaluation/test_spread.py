import statistics
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mjdrive.datatypes import Episode, Town
from mjdrive.evaluation.metrics import DriveSummary, summarise
from mjdrive.evaluation.spread import FIGURES, draw_spread, is_clean, summarise_drives

DISTANCES = (99.0, 150.0, 201.0)


@pytest.fixture
def drives(crossing: Town, make_drive: Callable[..., Episode]) -> list[DriveSummary]:
    drive = summarise(make_drive(np.linspace(0, 50, 51)), crossing)
    branches = ({}, {"left": 1}, {"straight": 2, "left": 1})
    return [
        replace(drive, distance_m=distance, seed=seed, branches_taken=taken)
        for seed, (distance, taken) in enumerate(zip(DISTANCES, branches, strict=True))
    ]


def test_figures_are_means_with_the_deviation_of_a_sample(
    drives: list[DriveSummary], crossing: Town
) -> None:
    summary = summarise_drives(drives, crossing)
    distance = summary.figures["distance_m"]
    assert distance.mean == statistics.mean(DISTANCES)
    assert distance.deviation == statistics.stdev(DISTANCES)
    assert (distance.smallest, distance.largest) == (99.0, 201.0)
    assert str(distance) == "150.0 ± 51.0"
    assert (summary.episodes, summary.seeds) == (3, (0, 1, 2))
    assert summary.branches_taken == {"left": 2, "straight": 2}
    assert summary.branches == 2


def test_one_drive_has_no_deviation(drives: list[DriveSummary], crossing: Town) -> None:
    assert summarise_drives(drives[:1], crossing).figures["distance_m"].deviation == 0.0


def test_clean_drives_went_somewhere_and_touched_nothing(drives: list[DriveSummary]) -> None:
    assert [is_clean(drive) for drive in drives] == [False, True, True]
    assert not is_clean(replace(drives[1], collisions=1))
    assert not is_clean(replace(drives[1], off_road_s=0.1))


@pytest.mark.parametrize("count", [1, 3])
def test_the_picture_is_drawn_and_shows_the_values(
    drives: list[DriveSummary], count: int, tmp_path: Path
) -> None:
    draw_spread(drives[:count], tmp_path / "one.png")
    draw_spread([replace(drive, distance_m=7.0) for drive in drives[:count]], tmp_path / "two.png")
    one, two = (np.asarray(Image.open(tmp_path / f"{name}.png")) for name in ("one", "two"))
    assert one.shape == two.shape
    assert (one != two).any()
    assert len(FIGURES) % 2 == 0
