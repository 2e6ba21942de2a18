"""`mjdrive tune`, and `--gains` of collect and drive."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from mjdrive import config
from mjdrive.cli.main import main
from mjdrive.config import PidConfig
from mjdrive.episodes import store
from mjdrive.tuning.gains import Evidence, Gains, plain
from mjdrive.tuning.marks import Marks
from mjdrive.vehicle import cars

DRIVE = ("drive", "--town", "town02", "--steps", "2")


def run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words), catch_exceptions=False)


@pytest.fixture(scope="module")
def tuned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which the PID was tuned to the default car, as short as can be."""
    folder = tmp_path_factory.mktemp("tuned")
    with pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.chdir(folder)
        done = run("tune", "--town", "town02", "--check-town", "town02", "--trials", "2")
    assert done.exit_code == 0
    assert "town02: off the route" in done.stdout
    return folder


@pytest.fixture
def workplace(tuned: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tuned)
    return tuned


def test_tuning_leaves_gains_trials_and_a_picture(workplace):
    names = {path.name for path in (workplace / "tunings/pid-default").iterdir()}
    assert names == {"gains.json", "trials.json", "tuning.png"}


def test_what_another_town_says_against_the_settings_is_told(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Gains, "doubt", "In town02 they drive worse.")
    done = run("tune", "--town", "town02", "--check-town", "town02", "--trials", "2")
    assert (done.exit_code, done.stderr.splitlines()[-1]) == (0, "In town02 they drive worse.")


def test_tuning_is_never_overwritten(workplace):
    again = run("tune", "--town", "town02", "--trials", "2")
    assert (again.exit_code, "is there already" in again.stderr) == (2, True)


def test_expert_drives_with_tuned_settings_and_says_so(workplace):
    path = workplace / "tunings/pid-default/gains.json"
    gains = json.loads(path.read_text())
    gains["settings"]["target_speed"] = 5.5
    (workplace / "slower.json").write_text(json.dumps(gains))
    done = run(*DRIVE, "--policy", "pid", "--gains", "slower.json", "--out", "d")
    assert done.exit_code == 0
    metadata = store.read(workplace / "d/episode.hdf5").metadata
    assert json.loads(metadata["settings"])["policy"]["target_speed"] == 5.5


def test_gains_of_another_car_are_refused_by_drive_and_collect(workplace):
    gains = ("--gains", "tunings/pid-default/gains.json", "--car", "mkz")
    for words in (
        (*DRIVE, "--policy", "pid", "--out", "e"),
        ("collect", "--town", "town02"),
    ):
        refused = run(*words, *gains)
        assert (refused.exit_code, "tuned for car 'default'" in refused.stderr) == (2, True)
    assert not (workplace / "e").exists()
    assert not (workplace / "data").exists()


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("braking", -1, "braking is -1.0; expected a positive number, not infinite"),
        ("throttle_cut", 7, "throttle_cut is 7.0; expected a share in [0, 1]"),
        ("target_distance", -5, "target_distance is -5.0; expected a positive number"),
        (
            "steering_gains",
            [float("nan"), 0.05, 0.0],
            "steering_gains is (nan, 0.05, 0.0); expected",
        ),
        ("speed_gains", [0.5], "speed_gains"),
    ],
)
def test_gains_that_make_no_sense_are_refused_before_anything_drives(
    tmp_path, monkeypatch, name, value, expected
):
    monkeypatch.chdir(tmp_path)
    marks = Marks(0.1, 0.5, 0.3, 1.5, 60.0, 0.1, 0, 3.0)
    evidence = Evidence("town02", "", before=marks, after=marks)
    settings = {**plain(PidConfig()), name: value}
    digest = cars.load().digest
    made = Gains("pid", "default", digest, settings, (name,), evidence, None, 2, 0, {}, {})
    config.write_json(made, tmp_path / "edited.json")
    for words in (
        (*DRIVE, "--policy", "pid", "--out", "f"),
        ("collect", "--town", "town02", "--preset", "quick"),
    ):
        refused = run(*words, "--gains", "edited.json")
        assert (refused.exit_code, expected in refused.stderr) == (2, True), refused.stderr
        assert "Tune again: `mjdrive tune pid --car default`" in refused.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["edited.json"]


def test_unknown_expert_is_refused_before_anything_runs(workplace):
    refused = run("tune", "pdi")
    assert (refused.exit_code, "Did you mean 'pid'" in refused.stderr) == (2, True)
