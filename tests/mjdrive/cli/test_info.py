import json
import os

import pytest
from click.testing import CliRunner

from mjdrive.cli import info
from mjdrive.cli.main import main
from mjdrive.errors import RenderError
from mjdrive.execution.pool import available_cores
from mjdrive.expert import mpc_solver
from mjdrive.simulation import opengl
from mjdrive.town import library
from models import hardware


def told() -> info.Facts:
    """Everything that `mjdrive info` says, whatever the subject."""
    result = CliRunner().invoke(main, ["info", "--json"], catch_exceptions=False)
    assert result.exit_code == 0
    return {
        name: value for facts in json.loads(result.stdout).values() for name, value in facts.items()
    }


def test_what_is_used_here_is_told() -> None:
    facts = told()
    assert facts["--jobs auto"] == (
        "1 process" if available_cores() == 1 else f"{available_cores()} processes"
    )
    assert facts["known"].split(", ") == list(library.town_names())
    assert facts["solver"] == "fatrop"
    assert facts["device used"] == str(hardware.choose_device())
    assert "mujoco" in facts["versions"]


def test_cores_threads_and_what_joins_processes_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    facts = told()
    assert facts["compiler"] == "none needed"
    assert facts["cores available"] == f"{available_cores()} of {os.cpu_count()}"
    assert facts["--jobs N"] == "3 threads a process, as OMP_NUM_THREADS says"
    kind = hardware.choose_device().type
    joined_by = {"cpu": "gloo", "cuda": "nccl"}[kind]
    assert facts["torchrun"] == f"{joined_by} between processes on {kind}"
    monkeypatch.delenv("OMP_NUM_THREADS")
    monkeypatch.setattr(os, "sched_getaffinity", lambda pid: set(range(6)))
    assert told()["--jobs N"] == "cores / N threads a process: 6 with 1, 1 with 6 and more"


@pytest.mark.usefixtures("on_one_core")
def test_of_one_core_one_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    facts = told()
    assert facts["cores available"].startswith("1 of ")
    assert facts["--jobs auto"] == "1 process"
    assert facts["--jobs N"] == "1 thread a process"


def test_table_shows_the_same_facts() -> None:
    shown = (
        CliRunner().invoke(main, ["info"], env={"COLUMNS": "240"}, catch_exceptions=False).stdout
    )
    for name, value in told().items():
        assert name in shown
        assert value.split(",")[0] in shown


@pytest.mark.parametrize(("is_fast", "expected"), [(True, "bfloat16"), (False, "float32")])
def test_number_format_is_what_the_machine_is_fast_at_and_float32_for_a_grid(
    is_fast: bool, expected: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hardware, "bfloat16_is_fast", lambda device="cpu": is_fast)
    facts = told()
    assert facts["trains in"] == expected
    assert facts["scores actions in"] == "float32, sampler grid"


def test_what_is_missing_is_told_with_what_to_do(monkeypatch: pytest.MonkeyPatch) -> None:
    def no_context(width: int, height: int) -> None:
        raise RenderError("No OpenGL found; apt-get install libegl1.")

    monkeypatch.setattr(opengl, "open_context", no_context)
    monkeypatch.setattr(mpc_solver.ca, "has_nlpsol", lambda name: False)
    monkeypatch.setattr(info.importlib.util, "find_spec", lambda name: None)
    monkeypatch.setattr(info.shutil, "which", lambda name: None)
    facts = told()
    assert facts["cameras"] == "none: No OpenGL found; apt-get install libegl1."
    assert facts["solver"].startswith("none: This casadi lacks plug-ins")
    assert facts["--backend ray"].startswith('not installed: pip install --editable ".[ray]"')
    assert facts["--backend slurm"].endswith("no command sbatch here")
