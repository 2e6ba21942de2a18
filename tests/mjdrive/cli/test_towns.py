"""`mjdrive towns` in an empty folder."""

import json
import re
import signal
from dataclasses import replace
from pathlib import Path

import mujoco
import pytest
from click.testing import CliRunner, Result

from mjdrive.cli.main import main
from mjdrive.config import write_json
from mjdrive.town import library, opendrive
from mjdrive.town.settings import LightTiming, TownSettings
from mjdrive.town.streets import generator
from mjdrive.town.streets.street_builder import build_map

SMALL = ("towns", "generate", "--junctions", "2", "--seed", "1", "--name", "small")


def invoke(*words: str) -> Result:
    return CliRunner().invoke(main, list(words), catch_exceptions=False)


def run(*words: str) -> str:
    result = invoke(*words)
    assert result.exit_code == 0, result.stderr
    return result.stdout


@pytest.fixture(autouse=True)
def workplace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder to work in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="module")
def small_map() -> bytes:
    """The map of the town that `SMALL` makes."""
    plan = generator.generate_plan(name="small", num_junctions=2, seed=1)
    return opendrive.write(build_map(plan))


def written(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def test_list_names_every_town_here() -> None:
    run(*SMALL)
    shown = run("towns", "list")
    for name in (*library.shipped_names(), "small"):
        assert name in shown


def test_a_generated_town_is_whole_and_the_same_for_the_same_seed(workplace: Path) -> None:
    run(*SMALL)
    first = written(workplace)
    names = {"map.xodr", "town.json", "map.png"}
    assert set(first) == {f"towns/small/{name}" for name in names}
    for file in (workplace / "towns/small").iterdir():
        file.unlink()
    (workplace / "towns/small").rmdir()
    run(*SMALL)
    assert written(workplace) == first
    run("towns", "export", "small", "scene.xml")
    mujoco.MjModel.from_xml_path("scene.xml")


def test_a_map_that_is_exported_and_imported_drives_the_same(
    workplace: Path, small_map: bytes
) -> None:
    run(*SMALL)
    run("towns", "export", "small", "copy.xodr")
    assert (workplace / "copy.xodr").read_bytes() == small_map
    run("towns", "import", "copy.xodr", "--name", "copy")
    assert (workplace / "towns/copy/map.xodr").read_bytes() == small_map
    original, copy = library.load("small"), library.load("copy")
    assert copy.lanes.keys() == original.lanes.keys()
    assert copy.lights.keys() == original.lights.keys()
    report = json.loads((workplace / "towns/copy/import.json").read_text())
    assert report["junctions"] == 2


def test_every_command_accepts_an_imported_town(workplace: Path, small_map: bytes) -> None:
    Path("copy.xodr").write_bytes(small_map)
    run("towns", "import", "copy.xodr", "--name", "copy")
    shown = run("drive", "--town", "copy", "--policy", "pid", "--steps", "30")
    assert "pid in copy" in shown
    settings = library.load_settings("copy")
    assert len(settings.routes) == 10
    short = {"short": settings.routes["route0"][:2]}
    write_json(replace(settings, routes=short), workplace / "towns/copy/town.json")
    run("collect", "--town", "copy")
    few = ("--preset", "quick", "--set", "optimiser.epochs=1")
    run("train", "bc-beta", *few, "--data", "data/copy")


def test_show_points_at_the_picture_or_draws_it(workplace: Path) -> None:
    assert "map.png" in run("towns", "show", "town01")
    run("towns", "show", "town01", "--picture", "mine.png")
    assert (workplace / "mine.png").read_bytes().startswith(b"\x89PNG")


def test_check_passes_our_towns_and_fails_a_town_with_a_dead_end(small_map: bytes) -> None:
    for name in library.shipped_names():
        run("towns", "check", name)
    document = small_map.decode()
    broken = re.sub(r'<successor elementType="junction" [^>]*>', "", document, count=1)
    assert broken != document
    Path("broken.xodr").write_text(broken)
    result = invoke("towns", "check", "broken.xodr")
    assert result.exit_code == 1
    assert "error" in result.stdout


def test_a_sloped_map_is_refused_unless_it_is_flattened(workplace: Path, small_map: bytes) -> None:
    slope = '</planView><elevationProfile><elevation s="0" a="0" b="0.1" c="0" d="0"/></elevationProfile>'
    Path("hill.xodr").write_text(small_map.decode().replace("</planView>", slope, 1))
    refused = invoke("towns", "import", "hill.xodr", "--name", "hill")
    assert refused.exit_code == 2
    assert "road '" in refused.stderr
    assert "--flatten" in refused.stderr
    assert set(written(workplace)) == {"hill.xodr"}
    shown = run("towns", "import", "hill.xodr", "--name", "hill", "--flatten")
    assert "flattened" in shown
    report = json.loads((workplace / "towns/hill/import.json").read_text())
    assert report["flattened"]["roads"] == 1
    assert report["flattened"]["slope"] == pytest.approx(0.1)
    assert library.load("hill").lanes


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("import", "nowhere.xodr", "--name", "new"), "Cannot read the map 'nowhere.xodr'"),
        (("import", "text.xodr", "--name", "new"), "'text.xodr' is no XML"),
        (("import", "good.xodr", "--name", "town01"), "There is a town 'town01' already"),
        (("import", "good.xodr", "--name", "taken"), "'towns/taken' is there already"),
        (("import", "good.xodr", "--name", "../up"), "A town cannot be called '../up'"),
        (("generate", "--junctions", "0", "--name", "new"), "num_junctions is 0"),
        (("show", "town1"), "Did you mean 'town01'?"),
        (("check", "town1"), "Did you mean 'town01'?"),
        (("export", "town01", "good.xodr"), "'good.xodr' is there already"),
        (("export", "town01", "town.pdf"), "expected a file that ends in .xodr"),
        (("show", "town01", "--picture", "town.jpg"), "expected a file that ends in .png"),
    ],
)
def test_mistakes_are_told_in_one_line_and_leave_nothing_behind(
    workplace: Path, small_map: bytes, words: tuple[str, ...], complaint: str
) -> None:
    Path("text.xodr").write_text("not a map")
    Path("good.xodr").write_bytes(small_map)
    Path("towns/taken").mkdir(parents=True)
    Path("towns/taken/notes.txt").write_text("mine")
    before = written(workplace)
    result = invoke("towns", *words)
    assert result.exit_code == 2
    assert complaint in result.stderr
    assert result.stderr.count("\n") == 1
    assert written(workplace) == before
    assert {path.name for path in (workplace / "towns").iterdir()} == {"taken"}


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_import_that_is_stopped_half_way_leaves_nothing_behind(
    workplace: Path, monkeypatch: pytest.MonkeyPatch, number: int, status: int
) -> None:
    def stop(*_: object) -> None:
        assert [path.name for path in (workplace / "towns").glob(".*")]
        signal.raise_signal(number)

    before = signal.getsignal(signal.SIGTERM)
    monkeypatch.setattr("mjdrive.town.picture.save", stop)
    assert invoke(*SMALL).exit_code == status
    assert written(workplace) == {}
    assert list((workplace / "towns").iterdir()) == []
    assert signal.getsignal(signal.SIGTERM) is before


def test_a_map_of_a_survey_is_moved_and_names_are_shown_as_they_are(
    workplace: Path, small_map: bytes
) -> None:
    far = re.sub(rb' x="([-0-9.e]+)"', lambda x: b' x="%r"' % (float(x[1]) + 692e3), small_map)
    Path("small[red].XODR").write_bytes(far)
    shown = run("towns", "check", "small[red].XODR")
    assert "small[red].XODR" in shown
    shown = run("towns", "import", "small[red].XODR", "--name", "far")
    assert "small[red].XODR: OpenDRIVE" in shown
    x, y = library.load_settings("far").origin
    assert x == pytest.approx(692e3, abs=1000.0)
    west, _, east, _ = library.load("far").bounds
    assert max(abs(west), abs(east)) < 1000.0
    assert y % 100.0 == 0.0


def test_settings_of_a_town_are_read_again_when_they_change(workplace: Path) -> None:
    run(*SMALL)
    before = library.load("small")
    assert library.load("small") is before
    settings = workplace / "towns/small/town.json"
    settings.write_text(json.dumps({"lights": {"green": 20.0}}))
    after = library.load("small")
    assert after.digest != before.digest
    assert library.load_settings("small") == TownSettings(lights=LightTiming(green=20.0))
