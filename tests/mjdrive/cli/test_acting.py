"""How a trained policy acts, changed from the command line."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from mjdrive.cli.driver import find_driver
from mjdrive.cli.main import main
from mjdrive.episodes import store

DRIVE = ("drive", "--town", "town02", "--policy", "zoo:da-ibc", "--steps", "3")


@pytest.fixture
def workplace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*words: str) -> Result:
    return CliRunner().invoke(main, [*DRIVE, *words], catch_exceptions=False)


def test_set_changes_how_it_acts_and_the_files_say_so(workplace: Path) -> None:
    changes = ("--set", "commitment.hold=0", "--set", "sampler.grid.temperature=0.5")
    done = run(*changes, "--out", "changed")
    assert done.exit_code == 0, done.stderr
    episode = store.read(workplace / "changed/episode.hdf5")
    policy = json.loads(episode.metadata["settings"])["policy"]
    assert policy["commitment"]["hold"] == 0
    assert policy["sampler"]["grid"]["temperature"] == 0.5


def test_set_changes_a_preset(tmp_path: Path) -> None:
    driver = find_driver(
        "zoo:da-ibc", tmp_path, preset="paper", acting=("sampler.dfo.iterations=7",)
    )
    sampler = json.loads(driver.settings)["sampler"]
    assert (sampler["kind"], sampler["dfo"]["iterations"]) == ("dfo", 7)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ("optimiser.epochs=5", "'optimiser.epochs=5' decides what is learnt"),
        ("commitment.hold", "Cannot set 'commitment.hold'"),
        ("commitments.hold=3", "Did you mean 'commitment.hold'"),
        ("flow.steps=3", "'flow.steps=3' has no effect on a policy of da-ibc"),
        ("sampler.dfo.iterations=3", "'sampler.dfo.iterations=3' has no effect"),
        ("commitment.hodl=3", "Did you mean 'commitment.hold'"),
        ("commitment.hold=-1", "in settings.commitment, hold is -1; expected zero"),
        ("sampler.kind=gird", "in settings.sampler.kind, there is no 'gird'; expected dfo, grid"),
    ],
)
def test_what_does_not_change_how_it_acts_is_refused(
    change: str, told: str, workplace: Path
) -> None:
    refused = run("--set", change)
    assert refused.exit_code == 2
    assert told in refused.stderr
    assert list(workplace.iterdir()) == []


@pytest.mark.parametrize("option", ["--set commitment.hold=0", "--preset paper"])
def test_neither_has_an_effect_on_an_expert(option: str, workplace: Path) -> None:
    refused = run("--policy", "pid", *option.split())
    assert refused.exit_code == 2
    assert f"{option} has no effect on 'pid', which mjdrive has not trained" in refused.stderr
    assert list(workplace.iterdir()) == []
