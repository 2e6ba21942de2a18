"""Plug-ins are installed into a folder of their own, as pip does, and found from there."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from mjdrive import plugins
from mjdrive.cli.driver import find_driver
from mjdrive.errors import ConfigError, PluginError, UnknownNameError
from mjdrive.expert import experts
from mjdrive.town import library
from mjdrive.vehicle import cars
from mjdrive.vehicle.parameters import VehicleParameters


def bring(folder: Path, package: str, group: str, **entries: str) -> None:
    """Write what an installed package leaves behind of its entry points."""
    about = folder / f"{package}-1.0.dist-info"
    about.mkdir(parents=True)
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n")
    lines = [f"{name} = {value}" for name, value in entries.items()]
    (about / "entry_points.txt").write_text("\n".join([f"[{group}]", *lines]))


@pytest.fixture
def broken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package whose module raises when it is imported, beside one whose expert works."""
    (tmp_path / "bursting.py").write_text("raise ZeroDivisionError('all is lost')")
    (tmp_path / "sound.py").write_text(
        "class Parked:\n"
        "    name = 'parked'\n"
        "    def __init__(self, town, *, parameters, control_interval): pass\n"
        "    def reset(self, seed): pass\n"
        "    def act(self, view): raise NotImplementedError\n"
        "seven = 7\n"
        "def make_seven(*args, **kwargs): return 7\n"
        "def burst(): raise ZeroDivisionError('all is lost')\n"
    )
    bring(tmp_path, "bursting", "mjdrive.experts", burst="bursting:Expert")
    bring(tmp_path, "sound", "mjdrive.experts", parked="sound:Parked", seven="sound:make_seven")
    bring(tmp_path, "homeless", "mjdrive.towns", nowhere="sound:seven", town02="sound:seven")
    policies = {"mute": "sound:make_seven", "absent": "sound:nothing", "late": "sound:burst"}
    bring(tmp_path, "mute", "mjdrive.policies", **policies)
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


def make(name: str) -> object:
    return experts.make_expert(name, library.load("town02"), parameters=VehicleParameters.default())


def test_broken_package_is_named_and_leaves_the_others_alone(broken: Path) -> None:
    with pytest.raises(PluginError, match=r"bursting 1.0 cannot be imported: ZeroDivisionError"):
        make("burst")
    assert make("parked").name == "parked"  # type: ignore[attr-defined]
    assert make("pid").name == "pid"  # type: ignore[attr-defined]


def test_what_is_no_policy_expert_or_town_is_refused(broken: Path) -> None:
    with pytest.raises(PluginError, match=r"expert 'seven' of sound 1.0 is a int; expected name"):
        make("seven")
    with pytest.raises(PluginError, match=r"policy 'mute' of mute 1.0 is a int; expected name"):
        find_driver("mute", broken)
    with pytest.raises(PluginError, match=r"absent.*AttributeError"):
        find_driver("absent", broken)
    with pytest.raises(PluginError, match=r"'late' of mute 1.0 cannot be made: ZeroDivisionError"):
        find_driver("late", broken)
    with pytest.raises(PluginError, match=r"town 'nowhere' of homeless 1.0 is 7; expected"):
        library.load("nowhere")


def test_names_of_ours_cannot_be_taken(broken: Path) -> None:
    assert library.load("town02").lanes


def test_two_packages_with_one_name_are_refused(broken: Path) -> None:
    bring(broken, "rival", "mjdrive.experts", parked="sound:Parked")
    with pytest.raises(PluginError, match=r"brought by .* and .*; expected one package"):
        make("parked")


def test_unknown_names_list_those_of_packages(broken: Path) -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'parked'"):
        find_driver("parkd", broken)
    with pytest.raises(UnknownNameError, match="nowhere"):
        library.load("nowher")


def test_preset_has_no_effect_on_a_plug_in(broken: Path) -> None:
    with pytest.raises(ConfigError, match="no effect on 'mute'"):
        find_driver("mute", broken, preset="paper")


def test_tuned_settings_have_no_effect_on_an_expert_of_a_package(broken: Path) -> None:
    with pytest.raises(ConfigError, match="no effect on parked"):
        find_driver("parked", broken).tuned(broken / "gains.json", cars.load())


def test_listing_tells_what_is_wrong(broken: Path) -> None:
    listed = {it.name: it for it in plugins.listing()}
    assert listed["parked"].source == "sound 1.0"
    assert listed["parked"].problem == ""
    assert "all is lost" in listed["burst"].problem


def run(site: Path, folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "mjdrive", *words],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(site), "COLUMNS": "200"},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("policy", ["example-policy", "example-expert"])
def test_example_package_drives_in_its_own_town(
    policy: str, example_package: Path, tmp_path: Path
) -> None:
    words = ("--town", "example-town", "--policy", policy, "--steps", "80")
    done = run(example_package, tmp_path, "drive", *words, "--out", "drive")
    assert done.returncode == 0, done.stderr
    assert f"{policy} in example-town" in done.stdout
    figures = (tmp_path / "drive" / "summary.json").read_text()
    assert '"road_departures": 0' in figures
    assert '"collisions": 0' in figures


def test_info_lists_the_example_package(example_package: Path, tmp_path: Path) -> None:
    shown = run(example_package, tmp_path, "info").stdout
    for name in ("policy example-policy", "expert example-expert", "town example-town"):
        assert name in shown
    assert "mjdrive-example 0.1.0" in shown
