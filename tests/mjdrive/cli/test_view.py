"""`mjdrive view` with a window that is none; a real one opens in tests/mjdrive/envs/test_windows.py."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from mjdrive.cli.main import main
from mjdrive.envs import viewer, window
from mjdrive.simulation.simulation import Simulation

shown: list[tuple[float, float]] = []


class Screen:
    """Shows five steps; then somebody closes it."""

    def __init__(self, simulation: Simulation, *, contacts: bool) -> None:
        self._simulation, self.contacts = simulation, contacts

    def show(self) -> None:
        if len(shown) == 5:
            raise viewer.ViewerClosedError
        shown.append((self._simulation.time, self._simulation.vehicle.speed))

    def close(self) -> None:
        shown.append((-1.0, 0.0))


def test_without_a_display_one_line_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(window.glfw, "init", lambda: False)
    done = CliRunner().invoke(main, ["view", "--town", "town02"])
    assert done.exit_code == 2
    assert done.stderr.startswith("Error: No window can be opened here")
    assert "Expected a display" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_closing_the_window_ends_the_drive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(window, "require_display", lambda: None)
    monkeypatch.setattr(viewer, "Viewer", Screen)
    done = CliRunner().invoke(
        main, ["view", "--town", "town02", "--steps", "50"], catch_exceptions=False
    )
    assert done.exit_code == 0
    times = [round(time, 1) for time, _ in shown]
    assert times == [0.1, 0.2, 0.3, 0.4, 0.5, -1.0]
    assert list(tmp_path.iterdir()) == []
