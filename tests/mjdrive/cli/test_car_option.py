"""`--car` of collect and drive: which car drove is never forgotten, and two cars are never mixed unseen."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from mjdrive.cli.driver import Driver
from mjdrive.cli.main import main
from mjdrive.datatypes import Town
from mjdrive.episodes import dataset, store
from mjdrive.town import library, routing
from mjdrive.town.settings import TownSettings
from mjdrive.vehicle import cars
from mjdrive.vehicle.assembly import car_path

COLLECT = ("collect", "--town", "town02", "--preset", "paper")
DRIVE = ("drive", "--town", "town02", "--policy", "pid", "--steps", "5")


def run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words), catch_exceptions=False)


@pytest.fixture
def workplace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, town02: Town) -> Path:
    """An empty folder, in a world where town02 has one route of 15 m."""
    rng = np.random.default_rng(0)
    lane, station = routing.random_start(town02, rng)
    route = routing.random_route(town02, lane=lane, station=station, length=15.0, rng=rng)
    places = tuple((float(x), float(y)) for x, y in route.points[[0, -1]])
    monkeypatch.setattr(library, "load_settings", lambda name: TownSettings(routes={"r": places}))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_data_set_says_which_car_drove_and_refuses_another(workplace):
    assert run(*COLLECT, "--car", "mkz").exit_code == 0
    manifest = dataset.read_manifest(workplace / "data/town02")
    assert (manifest.car, manifest.car_digest) == ("mkz", cars.load("mkz").digest)
    episode = store.read(workplace / "data/town02" / manifest.episodes[0].file)
    assert episode.metadata["car"] == "mkz"
    assert episode.metadata["car_digest"] == manifest.car_digest
    refused = run(*COLLECT)
    assert (refused.exit_code, "differs in car, car_digest" in refused.stderr) == (2, True)
    assert dataset.read_manifest(workplace / "data/town02") == manifest


def test_changed_car_file_is_another_car(workplace):
    path = workplace / "my_car.xml"
    path.write_text(car_path().read_text())
    assert run(*COLLECT, "--car", "my_car.xml").exit_code == 0
    path.write_text(car_path().read_text().replace('data="6000"', 'data="5000"'))
    refused = run(*COLLECT, "--car", "my_car.xml")
    assert (refused.exit_code, "differs in car_digest" in refused.stderr) == (2, True)


def test_drive_says_which_car_drove(workplace):
    done = run(*DRIVE, "--car", "mkz", "--out", "d")
    assert "mkz" in done.stdout
    assert json.loads((workplace / "d/summary.json").read_text())["car"] == "mkz"
    assert (
        store.read(workplace / "d/episode.hdf5").metadata["car_digest"] == cars.load("mkz").digest
    )


@pytest.mark.parametrize("command", [COLLECT, DRIVE])
@pytest.mark.parametrize(
    ("car", "message"),
    [
        ("mzk", "Did you mean 'mkz'"),
        ("absent.xml", "There is no car file 'absent.xml'"),
        ("broken.xml", "lacks: actuator 'brake'"),
    ],
)
def test_car_that_cannot_drive_is_refused_before_anything_is_written(
    workplace, command, car, message
):
    (workplace / "broken.xml").write_text(car_path().read_text().replace('"brake"', '"brakes"'))
    refused = run(*command, "--car", car)
    assert refused.exit_code == 2
    assert message in refused.stderr
    assert [path.name for path in workplace.iterdir()] == ["broken.xml"]


@pytest.mark.parametrize(
    ("learnt", "note"),
    [
        ({}, "mkz"),
        ({cars.load("mkz").digest: "mkz"}, "mkz"),
        ({cars.load("mkz").digest: "my_mkz.xml"}, "mkz"),
        ({"": "mkz"}, "mkz"),
        ({"": "default"}, "mkz; the policy learnt from default"),
        ({cars.load().digest: "default"}, "mkz; the policy learnt from default"),
        (
            {cars.load().digest: "default", cars.load("mkz").digest: "mkz"},
            "mkz; the policy learnt from default and mkz",
        ),
        ({"0" * 64: "mkz"}, "mkz; the policy learnt from another version of it"),
    ],
)
def test_note_names_the_cars_that_a_policy_learnt_from_if_there_are_others(learnt, note):
    assert Driver("bc", settings="{}", learnt_cars=learnt).car_note(cars.load("mkz")) == note


def test_policy_in_another_car_than_it_learnt_from_is_told_so(workplace):
    run(*COLLECT, "--car", "mkz")
    tiny = ("--preset", "quick", "--set", "optimiser.epochs=1")
    assert run("train", "bc-beta", "--data", "data/town02", *tiny).exit_code == 0
    done = run("drive", "--town", "town02", "--steps", "2", "--out", "d")
    assert "default; the policy learnt from mkz" in done.stdout
    metadata = store.read(workplace / "d/episode.hdf5").metadata
    assert metadata["car"] == "default"
    assert json.loads(metadata["policy_cars"]) == {cars.load("mkz").digest: "mkz"}
