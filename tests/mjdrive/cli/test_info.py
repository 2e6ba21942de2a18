import json

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
    assert facts["--jobs auto"] == f"{available_cores()} processes"
    assert facts["known"].split(", ") == list(library.town_names())
    assert facts["solver"] == "fatrop"
    assert facts["device used"] == str(hardware.choose_device())
    assert "mujoco" in facts["versions"]


def test_table_shows_the_same_facts() -> None:
    shown = (
        CliRunner().invoke(main, ["info"], env={"COLUMNS": "240"}, catch_exceptions=False).stdout
    )
    for name, value in told().items():
        assert name in shown
        assert value.split(",")[0] in shown


@pytest.mark.parametrize(("is_fast", "expected"), [(True, "bfloat16"), (False, "float32")])
def test_number_format_is_what_the_machine_is_fast_at(
    is_fast: bool, expected: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hardware, "bfloat16_is_fast", lambda device="cpu": is_fast)
    facts = told()
    assert facts["trains in"] == expected
    assert facts["scores actions in"].startswith(expected)


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
