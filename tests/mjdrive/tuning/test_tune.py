import dataclasses
import json

import pytest

from mjdrive.config import MpcConfig, PidConfig, TuneConfig, read_json, write_json
from mjdrive.errors import ConfigError
from mjdrive.tuning import gains, report
from mjdrive.tuning.gains import Gains
from mjdrive.tuning.search import best
from mjdrive.tuning.tune import Tuning, tune
from mjdrive.vehicle import cars

CONFIG = TuneConfig(trials=3, bends=1)


@pytest.fixture(scope="module")
def sluggish() -> PidConfig:
    """A PID that reacts to half of what it sees."""
    return PidConfig(steering_gains=(1.1, 0.05, 0.0))


@pytest.fixture(scope="module")
def tuning(town02, sluggish) -> Tuning:
    return tune(
        "pid", sluggish, car=cars.load(), town=town02, check_town=None, config=CONFIG, seed=0
    )


@pytest.fixture(scope="module")
def folder(tuning, tmp_path_factory):
    folder = tmp_path_factory.mktemp("tuning")
    report.write_tuning(tuning, folder)
    return folder


def test_tuned_settings_are_those_of_the_cheapest_trial(tuning, sluggish):
    cheapest = best(tuning.tried)
    assert tuning.gains.tuned_on.after == cheapest.marks
    assert tuning.gains.settings == gains.plain(cheapest.settings)
    assert tuning.tried[0].settings == sluggish
    assert tuning.gains.tuned_on.before == tuning.tried[0].marks
    assert tuning.gains.trials == 3


def test_same_seed_tunes_to_the_same_gains(tuning, sluggish, town02):
    again = tune(
        "pid", sluggish, car=cars.load(), town=town02, check_town=None, config=CONFIG, seed=0
    )
    assert again.gains == tuning.gains


def test_gains_come_back_from_their_file(folder, tuning):
    settings = gains.load(folder / report.GAINS, PidConfig, cars.load())
    assert gains.plain(settings) == tuning.gains.settings
    assert read_json(Gains, folder / report.GAINS) == tuning.gains


def test_every_trial_is_written_with_its_marks(folder, tuning):
    trials = json.loads((folder / report.TRIALS).read_text())
    assert [trial["marks"]["cost"] for trial in trials] == [
        tried.marks.cost for tried in tuning.tried
    ]


def test_picture_is_the_same_for_the_same_tuning(folder, tuning, tmp_path):
    report.draw_tuning(tuning, tmp_path / "again.png")
    assert (tmp_path / "again.png").read_bytes() == (folder / report.PICTURE).read_bytes()


def test_gains_of_another_car_or_expert_or_format_are_refused(folder, tuning, tmp_path):
    mkz = cars.load("mkz")
    with pytest.raises(ConfigError, match=r"tuned for car 'default'.*--car mkz"):
        gains.load(folder / report.GAINS, PidConfig, mkz)
    with pytest.raises(ConfigError, match="tuned for the expert pid, not mpc"):
        gains.load(folder / report.GAINS, MpcConfig, cars.load())
    write_json(dataclasses.replace(tuning.gains, format="other"), tmp_path / "other.json")
    with pytest.raises(ConfigError, match="format 'other'"):
        gains.load(tmp_path / "other.json", PidConfig, cars.load())


def test_file_that_holds_no_gains_is_refused(tmp_path):
    (tmp_path / "no.json").write_text('{"steering": 2}')
    with pytest.raises(ConfigError, match=r"no\.json' holds no tuned settings.*steering"):
        gains.load(tmp_path / "no.json", PidConfig, cars.load())
    with pytest.raises(ConfigError, match="Cannot read settings"):
        gains.load(tmp_path / "missing.json", PidConfig, cars.load())


def test_damaged_gains_are_refused_by_the_name_of_their_file(tuning, tmp_path):
    path = tmp_path / "damaged.json"
    values = gains.plain(tuning.gains)
    settings = values["settings"]
    for damaged, reason in (
        ({name: value for name, value in values.items() if name != "car_digest"}, "car_digest"),
        (values | {"settings": settings | {"target_speed": -1.0}}, "target_speed"),
        (values | {"settings": settings | {"colour": 1.0}}, "colour"),
    ):
        path.write_text(json.dumps(damaged))
        with pytest.raises(ConfigError, match=rf"damaged\.json.*{reason}"):
            gains.load(path, PidConfig, cars.load())
