import dataclasses
import shutil
from pathlib import Path

import pytest

from mjdrive.errors import ConfigError, TownFormatError, UnknownNameError, WorkerError
from mjdrive.town import library
from mjdrive.town.lane_graph import lane_length


def test_the_two_towns_are_there() -> None:
    assert {"town01", "town02"} <= set(library.shipped_names())


@pytest.mark.parametrize(
    ("name", "outside", "inside"), [("town01", 4959.6, 1442.5), ("town02", 2112.4, 806.9)]
)
def test_towns_have_the_lengths_of_their_originals(
    name: str, outside: float, inside: float
) -> None:
    lanes = library.load(name).lanes.values()
    lengths = {
        crossing: sum(
            lane_length(lane) for lane in lanes if (lane.junction is not None) == crossing
        )
        for crossing in (False, True)
    }
    assert lengths[False] == pytest.approx(outside, rel=0.001)
    assert lengths[True] == pytest.approx(inside, rel=0.001)


@pytest.mark.parametrize(("name", "junctions", "lights"), [("town01", 12, 36), ("town02", 8, 24)])
def test_towns_have_the_junctions_and_lights_of_their_originals(
    name: str, junctions: int, lights: int
) -> None:
    town = library.load(name)
    assert len({lane.junction for lane in town.lanes.values()} - {None}) == junctions
    assert len(town.lights) == lights
    assert town.name == name


def test_an_unknown_town_is_answered_with_the_nearest_name() -> None:
    with pytest.raises(
        UnknownNameError, match=r"Unknown town 'town1'.*town01, town02.*Did you mean 'town01'\?"
    ):
        library.load("town1")
    with pytest.raises(UnknownNameError, match="Unknown town 'twon02'"):
        library.load_settings("twon02")


def test_a_name_cannot_lead_out_of_the_folder() -> None:
    with pytest.raises(UnknownNameError):
        library.load("../towns/town01")


@pytest.mark.parametrize("missing", ["map.xodr", "town.json"])
def test_an_incomplete_folder_is_refused(tmp_path: Path, missing: str) -> None:
    folder = tmp_path / "mine"
    shutil.copytree(library.folder_of("town02"), folder)
    (folder / missing).unlink()
    with pytest.raises(TownFormatError, match=f"mine' has no {missing}"):
        library.load_folder(folder)


def test_a_copied_town_keeps_its_digest_until_it_changes(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    shutil.copytree(library.folder_of("town02"), folder)
    copy = library.load_folder(folder)
    assert (copy.name, copy.digest) == ("mine", library.load("town02").digest)
    settings = folder / "town.json"
    settings.write_text(settings.read_text().replace('"green": 10.0', '"green": 12.0'))
    changed = library.load_folder(folder)
    assert changed.digest != copy.digest
    assert next(iter(changed.lights.values())).program[0][1] == 12.0


def test_broken_settings_are_refused(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    shutil.copytree(library.folder_of("town02"), folder)
    (folder / "town.json").write_text('{"lamps": {}}')
    with pytest.raises(ConfigError, match="lamps"):
        library.load_folder(folder)


def test_without_towns_the_folders_searched_are_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(library, "__file__", str(tmp_path / "mjdrive" / "town" / "library.py"))
    with pytest.raises(TownFormatError, match=r"assets/towns' and '.*mjdrive/assets/towns"):
        library.towns_folder()
    inside = tmp_path / "mjdrive" / "assets" / "towns"
    inside.mkdir(parents=True)
    assert library.towns_folder() == inside
    outside = tmp_path / "assets" / "towns"
    outside.mkdir(parents=True)
    assert library.towns_folder() == outside


def test_town_that_differs_or_is_missing_here_is_refused() -> None:
    town = library.load("town02")
    library.require_same(town)
    with pytest.raises(WorkerError, match=rf"'town02' is {town.digest}; expected .* 0000"):
        library.require_same(dataclasses.replace(town, digest="0000"))
    with pytest.raises(WorkerError, match="'elsewhere' is missing"):
        library.require_same(dataclasses.replace(town, name="elsewhere"))
