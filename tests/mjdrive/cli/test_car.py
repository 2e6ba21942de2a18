"""`mjdrive car`: tables, files and exit statuses; what is measured has tests of its own."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from mjdrive.cli.car_tables import limits, number
from mjdrive.cli.main import main
from mjdrive.manoeuvres import comparison, multi_body, steady_circle, step_steer, suite
from mjdrive.manoeuvres.bars import Bar
from mjdrive.manoeuvres.comparison import Behaviour, Comparison
from mjdrive.manoeuvres.handling import Handling
from mjdrive.manoeuvres.rig import Rig
from mjdrive.manoeuvres.single_track_cars import LinearCar
from mjdrive.manoeuvres.suite import Plan, Report, Track
from mjdrive.vehicle.cars import CarModel

GOOD = Bar("braking", "50 to 0 km/h", 10.7, "m", 9.8, 12.0, "friction")
BAD = Bar("braking", "100 to 0 km/h", 60.0, "m", 37.4, 45.7, "friction")


def run(*words: str) -> Result:
    return CliRunner().invoke(main, ["car", *words])


@pytest.fixture(autouse=True)
def in_new_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def measured(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, Plan]]:
    """Stands in for ten minutes of driving: one good bar, and a bad one for the mkz."""
    asked = []

    def drive(car: CarModel, plan: Plan, track: Track) -> Report:
        asked.append((car.name, plan))
        track("manoeuvres", 1)()
        bars = (GOOD, BAD) if car.name == "mkz" else (GOOD,)
        return Report(car, object.__new__(Handling), bars)

    monkeypatch.setattr(suite, "run", drive)
    return asked


def test_every_bar_that_holds_is_shown_and_written(measured, tmp_path):
    result = run("test", "--out", "report")
    assert result.exit_code == 0, result.output
    assert "1 of 1 bars hold" in result.output
    assert "9.80 to 12 m" in result.output
    report = json.loads((tmp_path / "report/report.json").read_text())
    assert report["format"] == "mjdrive-car-test-1"
    assert report["car"] == "default"
    assert len(report["car_digest"]) == 64
    assert report["bars"][0]["holds"] is True
    assert report["bars"][0]["measured"] == 10.7
    assert measured == [("default", Plan())]


def test_bar_that_fails_is_exit_status_1(measured, tmp_path):
    result = run("test", "--car", "mkz", "--out", "report")
    assert result.exit_code == 1
    assert "1 of 2 bars hold" in result.output
    assert "NO" in result.output
    report = json.loads((tmp_path / "report/report.json").read_text())
    assert [bar["holds"] for bar in report["bars"]] == [True, False]


def test_quick_drives_less(measured):
    assert run("test", "--quick").exit_code == 0
    assert measured == [("default", suite.QUICK)]
    assert suite.QUICK.num_seeds < Plan().num_seeds


def test_folder_that_holds_something_is_refused_before_anything_is_driven(measured, tmp_path):
    (tmp_path / "full").mkdir()
    (tmp_path / "full/file").touch()
    for command in ("test", "compare"):
        result = run(command, "--out", "full")
        assert result.exit_code == 2
        assert "is there already" in result.output
    assert measured == []


def test_unknown_car_is_refused_before_anything_is_driven(measured):
    for command in ("test", "compare"):
        assert run(command, "--car", "nonesuch").exit_code == 2
    assert measured == []


def test_comparison_says_what_is_missing_and_shows_the_others(monkeypatch, tmp_path):
    monkeypatch.setattr(steady_circle, "RAMP", 10.0)
    monkeypatch.setattr(multi_body, "is_installed", lambda: False)
    car = LinearCar(Rig.of_car().single_track, max_steering_angle=0.6, steering_rate=0.48)
    circles = {kmh: steady_circle.circle(car, kmh) for kmh in (30, 80)}
    behaviour = Behaviour(circles, step_steer.step(car), slides=False)
    monkeypatch.setattr(
        comparison, "compare", lambda *_: Comparison("our car", {"default": behaviour})
    )
    result = run("compare", "--out", "compared")
    assert result.exit_code == 0, result.output
    assert "pip install commonroad-vehicle-models" in result.output
    assert "yaw-rate gain" in result.output
    assert (tmp_path / "compared/comparison.png").exists()
    assert list(json.loads((tmp_path / "compared/comparison.json").read_text())) == ["our car"]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"), (12.0, "12"), (1234.5, "1,234"), (12.345, "12.3"), (1.2345, "1.23"),
        (0.012345, "0.0123"), (-0.5, "-0.500"), (-1e-7, "0"), (-10.0, "-10"), (float("nan"), "-"),
    ],
)  # fmt: skip
def test_numbers_have_three_digits_that_matter(value, text):
    assert number(value, "") == text


def test_limits_are_told_in_words():
    assert limits(GOOD) == "9.80 to 12 m"
    assert limits(Bar("a", "b", 1.0, "m", most=2.5)) == "at most 2.50 m"
    assert limits(Bar("a", "b", 1.0, "m", least=0.25)) == "at least 0.250 m"
    assert limits(Bar("a", "b", 1.0, "m")) == "any"
