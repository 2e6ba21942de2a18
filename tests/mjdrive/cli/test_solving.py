"""`--solver` and `--fallback-solver` of collect and drive, and what their tables say of solves."""

import json
from pathlib import Path

import casadi
import pytest
from click.testing import CliRunner, Result

from mjdrive.cli.driver import Driver
from mjdrive.cli.main import main
from mjdrive.cli.solving import late_row, solve_rows
from mjdrive.episodes import dataset, store
from mjdrive.errors import ConfigError
from mjdrive.expert.mpc_solver import SOLVERS

DRIVE = ("drive", "--town", "town02", "--steps", "5")
COLLECT = ("collect", "--town", "town02", "--random-walk", "0.05", "--episodes", "1")


def run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words), catch_exceptions=False)


@pytest.fixture
def workplace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_chosen_solver_collects_and_is_told(workplace: Path) -> None:
    done = run(*COLLECT, "--expert", "mpc", "--solver", "ipopt", "--out", "data")
    assert done.exit_code == 0, done.stderr
    words = " ".join(done.stdout.split())
    assert "solver │ ipopt" in words
    assert "solves │" in words
    assert "late solves │" in words
    (entry,) = dataset.read_manifest(workplace / "data").episodes
    assert (entry.solver, entry.solves["solved"] > 0) == ("ipopt", True)


def test_stand_in_drives_where_the_solver_is_missing(
    workplace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    has = casadi.has_nlpsol
    monkeypatch.setattr(casadi, "has_nlpsol", lambda name: name != "fatrop" and has(name))
    refused = run(*DRIVE, "--policy", "mpc", "--out", "d")
    assert (refused.exit_code, "needs nlpsol 'fatrop'" in refused.stderr) == (2, True)
    assert list(workplace.iterdir()) == []
    done = run(*DRIVE, "--policy", "mpc", "--fallback-solver", "ipopt", "--out", "d")
    assert "solver │ ipopt" in " ".join(done.stdout.replace("solver  ", "solver ").split())
    metadata = store.read(workplace / "d/episode.hdf5").metadata
    assert metadata["solver"] == "ipopt"
    assert sum(json.loads(metadata["solves"]).values()) == 5
    assert json.loads(metadata["settings"])["policy"]["fallback_solver"] == "ipopt"


def test_unknown_solver_is_refused_with_the_known_ones(workplace: Path) -> None:
    for words in ((*DRIVE, "--policy", "mpc"), (*COLLECT, "--expert", "mpc")):
        refused = run(*words, "--solver", "simplex")
        assert refused.exit_code == 2
        assert all(name in refused.stderr for name in ("'simplex'", *SOLVERS))
    assert list(workplace.iterdir()) == []


@pytest.mark.parametrize("option", ["--solver", "--fallback-solver"])
def test_solver_of_an_expert_that_solves_nothing_is_refused(option: str, workplace: Path) -> None:
    for words in ((*DRIVE, "--policy", "pid"), (*COLLECT, "--expert", "pid")):
        refused = run(*words, option, "ipopt")
        assert refused.exit_code == 2
        assert "ipopt solves nothing for the expert pid. Expected the expert mpc" in refused.stderr
    assert list(workplace.iterdir()) == []


def test_solver_of_a_trained_policy_is_refused() -> None:
    policy = Driver("da-ibc", settings="{}")
    assert policy.solved_by(None, None) is policy
    with pytest.raises(ConfigError, match=r"trained policy da-ibc.*--policy mpc"):
        policy.solved_by("ipopt", None)


def test_help_names_every_solver() -> None:
    shown = " ".join(run("drive", "--help").stdout.split())
    for part in {part for name in SOLVERS for part in name.split("+")}:
        assert part in shown


def test_tables_sum_up_what_happened() -> None:
    drives = [{"solved": 1200, "failed": 0, "recoveries": 3}, {"solved": 34, "max_iterations": 2}]
    assert solve_rows(["fatrop", "fatrop"], drives) == {
        "solver": "fatrop",
        "solves": "1,234 solved, 2 out of iterations, 0 failed, 3 left to the PID after a push",
    }
    assert solve_rows(["ipopt", "", "fatrop"], drives)["solver"] == "fatrop, ipopt"
    assert solve_rows(["", ""], [{}, {}]) == {}
    assert late_row(2, 0.05) == {"late solves": "2 took over 50 ms of CPU time here"}
