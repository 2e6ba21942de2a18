import re
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

import mjdrive
from mjdrive.cli.main import main

HEAVY = ("torch", "mujoco", "numpy", "matplotlib", "cv2", "h5py", "shapely")


def run(*words: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(main, list(words), catch_exceptions=False)
    return result.exit_code, result.stdout, result.stderr


def test_help_imports_nothing_heavy() -> None:
    program = (
        "import sys; sys.argv = ['mjdrive', '--help']\n"
        "from mjdrive.cli.main import main\n"
        "main(standalone_mode=False)\n"
        f"print('loaded:', [name for name in {HEAVY} if name in sys.modules])"
    )
    shown = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    ).stdout
    assert "mjdrive collect --town town01" in shown
    assert shown.endswith("loaded: []\n")


def test_version_is_that_of_the_package() -> None:
    assert run("--version") == (0, f"mjdrive, version {mjdrive.__version__}\n", "")


MISTAKES = {
    "unknown town": (["drive", "--town", "town2"], "Unknown town 'town2'.*Did you mean 'town02'"),
    "unknown town to collect in": (["collect", "--town", "town1"], "Unknown town 'town1'"),
    "unknown collect preset": (
        ["collect", "--town", "town01", "--preset", "quik"],
        "preset 'quik'.*Did you mean 'quick'",
    ),
    "negative noise": (["collect", "--town", "town02", "--noise", "-1"], "noise is -1; expected 0"),
    "unknown route": (
        ["collect", "--town", "town02", "--routes", "nope"],
        "route 'nope'.*Known: route0",
    ),
    "number of no route": (
        ["collect", "--town", "town02", "--routes", "4-9"],
        "no routes '4-9'; expected numbers from 0 to 5",
    ),
    "walk back": (
        ["collect", "--town", "town02", "--random-walk", "-1"],
        "random walk is -1 km; expected more than 0",
    ),
    "walk along routes": (
        ["collect", "--town", "town02", "--random-walk", "1", "--routes", "0"],
        "follows no routes",
    ),
    "unknown expert": (
        ["collect", "--town", "town02", "--expert", "mcp"],
        "expert 'mcp'.*Did you mean 'mpc'",
    ),
    "both to replace and to add": (
        ["collect", "--town", "town02", "--overwrite", "--mix"],
        "expected one of them",
    ),
    "unknown train preset": (
        ["train", "ibc", "--preset", "papr"],
        "preset 'papr'.*Did you mean 'paper'",
    ),
    "unknown method": (["train", "da-ibcc"], "method 'da-ibcc'.*Did you mean 'da-ibc'"),
    "unknown setting": (
        ["train", "ibc", "--set", "optimizer.epochs=3"],
        "setting 'optimizer.epochs'.*Did you mean 'optimiser.epochs'",
    ),
    "missing data": (["train", "ibc"], "'data/town01' does not exist.*mjdrive collect"),
    "nothing to resume": (["train", "ibc", "--resume"], "no complete epoch to resume"),
    "unknown policy": (
        ["drive", "--town", "town02", "--policy", "pd"],
        "policy 'pd'.*Did you mean 'pid'",
    ),
    "jobs for a single drive": (
        ["drive", "--town", "town02", "--policy", "pid", "--jobs", "2"],
        "expected --episodes N with them",
    ),
    "unknown backend": (
        ["collect", "--town", "town02", "--backend", "slrm"],
        "backend 'slrm'.*Did you mean 'slurm'",
    ),
    "address without a cluster": (
        ["collect", "--town", "town02", "--address", "10.0.0.7:6379"],
        "no effect with --backend local",
    ),
    "dead address": (
        ["collect", "--town", "town02", "--backend", "ray", "--address", "127.0.0.1:1"],
        "Nobody answers at '127.0.0.1:1'.*ray start --head",
    ),
    "folder that is no run": (
        ["drive", "--town", "town02", "--policy", "."],
        "no complete training run",
    ),
}


@pytest.mark.parametrize(("words", "message"), MISTAKES.values(), ids=MISTAKES.keys())
def test_mistakes_are_one_line_and_leave_nothing(
    words: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    status, shown, complaint = run(*words)
    assert (status, shown) == (2, "")
    last = complaint.rstrip("\n").rpartition("\n")[2]
    assert last.startswith("Error: ")
    assert re.search(message, last)
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_exits_with_130(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(name: str) -> None:
        raise KeyboardInterrupt

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("mjdrive.town.library.load", interrupt)
    status, _, complaint = run("drive", "--town", "town02")
    assert status == 130
    assert "Interrupted" in complaint
    assert list(tmp_path.iterdir()) == []


def test_defects_are_not_hidden(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(name: str) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("mjdrive.town.library.load", fail)
    with pytest.raises(ZeroDivisionError):
        run("drive", "--town", "town02")
