import json
from pathlib import Path

import pytest

from mjdrive import config
from mjdrive.errors import DataError
from mjdrive.evaluation.lane_keeping import LaneKeeping
from mjdrive.evaluation.metrics import DriveSummary
from mjdrive.zoo.evaluations import read_evaluation
from models import presets, serialization
from models.config import LearnerConfig

ACTING = presets.standard("da-ibc")
DIGEST = "ab" * 32
LANE_KEEPING = LaneKeeping(
    offset_mean_m=None,
    offset_rms_m=None,
    offset_p95_m=None,
    junction_offset_mean_m=None,
    heading_error_rms_rad=None,
)
NAMELESS = '{"town": "town02", "settings": "{\\"policy\\": {}}"}'
"""Drives of nobody knows whom."""


def summary(distance: float) -> DriveSummary:
    return DriveSummary(
        town="town02",
        car="default",
        policy="da-ibc",
        seed=1,
        steps=3000,
        duration_s=300.0,
        distance_m=distance,
        red_lights=1,
        collisions=0,
        kerb_strikes=0,
        road_departures=0,
        wrong_ways=0,
        standstills=0,
        off_road_s=0.0,
        stuck_s=0.0,
        score=0.7 * distance,
        lane_keeping=LANE_KEEPING,
        branches_taken={"a": 1},
        versions={},
    )


@pytest.fixture
def drives(tmp_path: Path) -> Path:
    """Two drives, as `mjdrive drive --episodes 2 --seed 5` leaves them."""
    settings = json.loads(serialization.to_json(ACTING))
    settings["sampler"]["precision"] = "bfloat16"  # as a machine settled on
    description = {
        "town": "town02",
        "car": "default",
        "seed": "5",
        "policy_digest": DIGEST,
        "settings": json.dumps({"policy": settings}),
    }
    (tmp_path / "drives.json").write_text(json.dumps(description))
    for index, distance in enumerate((1000.0, 1100.0)):
        config.write_json(summary(distance), tmp_path / f"episode-{index}" / "summary.json")
    return tmp_path


def read(folder: Path, *, acting: LearnerConfig = ACTING, digest: str = DIGEST):
    return read_evaluation(folder, name="mine", acting=acting, digests=[digest])


def test_figures_are_averaged_and_the_command_makes_the_drives_again(drives: Path) -> None:
    found = read(drives)
    assert found.summary.figures["distance_m"].mean == 1050.0
    assert (found.summary.episodes, found.steps, found.weights_sha256) == (2, 3000, DIGEST)
    assert found.command == (
        "mjdrive drive --policy zoo:mine --town town02 --steps 3000 --episodes 2 --seed 5"
    )


def test_drives_of_compared_policies_are_made_again_by_their_script(drives: Path) -> None:
    path = drives / "drives.json"
    values = json.loads(path.read_text())
    del values["seed"]
    path.write_text(json.dumps(values))
    assert read(drives).command == (
        "python scripts/compare_policies.py zoo:mine --town town02 --steps 3000 --seeds 2"
    )


def test_drives_of_other_weights_are_refused(drives: Path) -> None:
    with pytest.raises(DataError, match="made by the weights abababababab; expected cdcdcdcdcdcd"):
        read(drives, digest="cd" * 32)


def test_drives_with_another_way_to_act_are_refused(drives: Path) -> None:
    with pytest.raises(DataError, match="other settings"):
        read(drives, acting=presets.paper("da-ibc"))


@pytest.mark.parametrize("content", [None, "", "[]", "{}", '{"settings": "no"}', NAMELESS])
def test_a_folder_that_says_nothing_of_its_drives_is_refused(
    drives: Path, content: str | None
) -> None:
    path = drives / "drives.json"
    path.unlink() if content is None else path.write_text(content)
    with pytest.raises(DataError, match=r"Cannot read '.*drives.json'"):
        read(drives)


def test_a_folder_without_a_drive_is_refused(drives: Path) -> None:
    for path in drives.glob("*/summary.json"):
        path.unlink()
    with pytest.raises(DataError, match="holds no drive"):
        read(drives)
