"""`--solver`, `--fallback-solver` and `--late-plan` of collect and drive, and what their tables say of solves."""

import functools
import json
import re
from pathlib import Path

import casadi
import numpy as np
import pytest
from click.testing import CliRunner, Result

from mjdrive.cli.driver import Driver
from mjdrive.cli.main import main
from mjdrive.cli.solving import late_row, solve_rows
from mjdrive.config import CollectConfig, MpcConfig
from mjdrive.episodes import dataset, presets, store
from mjdrive.episodes.presets import SolverChoice
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
    assert "late plans │" in words
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


@pytest.mark.parametrize("option", ["--solver ipopt", "--fallback-solver ipopt", "--late-plan pid"])
def test_choice_for_an_expert_that_solves_nothing_is_refused(option: str, workplace: Path) -> None:
    for words in ((*DRIVE, "--policy", "pid"), (*COLLECT, "--expert", "pid")):
        refused = run(*words, *option.split())
        assert refused.exit_code == 2
        assert f"{option} has no effect on the expert pid" in refused.stderr
        assert "Expected the expert mpc" in refused.stderr
    assert list(workplace.iterdir()) == []


def test_solver_of_a_trained_policy_is_refused() -> None:
    policy = Driver("da-ibc", settings="{}")
    assert policy.solved_by(SolverChoice()) is policy
    with pytest.raises(ConfigError, match=r"--solver ipopt .*trained policy da-ibc.*--policy mpc"):
        policy.solved_by(SolverChoice(solver="ipopt"))


def test_late_plans_are_left_to_the_pid_when_told_and_the_files_say_so(
    workplace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    hurried = functools.partial(MpcConfig, late_after=1e-9)  # no machine decides as quickly
    monkeypatch.setattr(presets, "CollectConfig", lambda **kw: CollectConfig(mpc=hurried(), **kw))
    done = run(*COLLECT, "--expert", "mpc", "--late-plan", "pid", "--out", "data")
    assert done.exit_code == 0, done.stderr
    words = " ".join(done.stdout.split())
    told = re.search(r"late plans │ (\d+) decisions took over 1e-06 ms of CPU time here", words)
    assert told is not None, words
    (collection,) = dataset.read_manifest(workplace / "data").collections
    assert collection.settings["mpc"]["late_plan"] == "pid"
    (entry,) = dataset.read_manifest(workplace / "data").episodes
    assert int(told[1]) == entry.solves["solved"] > 0
    run(*COLLECT, "--noise", "1", "--out", "pid")
    plain, late = (store.read(workplace / it / entry.file) for it in ("pid", "data"))
    assert np.array_equal(plain.actions, late.actions)


def test_drive_says_what_it_does_with_late_plans(workplace: Path) -> None:
    done = run(*DRIVE, "--policy", "mpc", "--late-plan", "pid", "--out", "d")
    assert "left to the PID" in " ".join(done.stdout.split())
    metadata = store.read(workplace / "d/episode.hdf5").metadata
    assert json.loads(metadata["settings"])["policy"]["late_plan"] == "pid"


def test_unknown_answer_to_late_plans_is_refused(workplace: Path) -> None:
    for words in ((*DRIVE, "--policy", "mpc"), (*COLLECT, "--expert", "mpc")):
        refused = run(*words, "--late-plan", "wait")
        assert refused.exit_code == 2
        assert "'wait' is not one of 'plan', 'pid'" in " ".join(refused.stderr.split())
    assert list(workplace.iterdir()) == []


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
    told = "2 decisions took over 50 ms of CPU time here"
    assert late_row(2, 0.05, "plan") == {"late plans": told}
    assert late_row(2, 0.05, "pid") == {"late plans": f"{told}, and were left to the PID"}
