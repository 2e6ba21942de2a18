"""Real windows, on a display that nobody looks at: MuJoCo's viewer, dm_control's, and Gymnasium's human mode."""

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from shutil import which
from typing import NamedTuple

import numpy as np
import pytest

PATIENCE = 240.0
"""For a window to open on a busy machine [s]."""

DM_CONTROL = """
import glfw
import numpy as np
from dm_control.viewer.application import Application
from mjdrive.envs import dm_environment

environment = dm_environment.load("town02", time_limit=60.0)
application = Application(width=320, height=240)
window, speeds = application._window, []

def drive(step):
    speeds.append(float(step.observation["state"][0]))
    if len(speeds) == 8:
        application._restart_runtime()  # as Backspace does
    if len(speeds) == 16:
        glfw.set_window_should_close(window._context.window, True)
    return np.array([1.0, 0.0])

application._pause_subject.toggle()  # as the space bar does
application.launch(environment, drive)
print(*speeds)
"""

CHECK_ENV = """
import warnings
import gymnasium
from gymnasium.utils.env_checker import check_env
import mjdrive

environment = gymnasium.make("mjdrive/Town02-v0", render_mode="human")
warnings.simplefilter("error")
check_env(environment.unwrapped)
"""


class Display(NamedTuple):
    """A display without a screen.

    Attributes:
        environment: Of programs that use it.
        memory: File with what it shows, as `xwd` writes it.
    """

    environment: dict[str, str]
    memory: Path

    def num_colours(self) -> int:
        """How many different colours are shown now [-]."""
        content = self.memory.read_bytes()
        header = np.frombuffer(content, ">u4", 25)
        start = int(
            header[0] + 12 * header[19]
        )  # the header says how long it is, and how many colours follow
        return len(np.unique(np.frombuffer(content, "<u4", offset=start)))


@pytest.fixture(scope="module")
def display(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Display]:
    server = which("Xvfb")
    if server is None:
        pytest.skip("no Xvfb on this machine; see scripts/install_system_packages.sh")
    folder = tmp_path_factory.mktemp("display")
    reading, writing = os.pipe()
    words = ["-displayfd", str(writing), "-screen", "0", "800x600x24", "-fbdir", str(folder)]
    command = [server, *words, "-nolisten", "tcp"]
    kept = {
        it: value
        for it, value in os.environ.items()
        if it not in ("MUJOCO_GL", "PYOPENGL_PLATFORM")
    }
    with subprocess.Popen(command, pass_fds=[writing], stderr=subprocess.DEVNULL) as process:
        os.close(writing)
        with os.fdopen(reading) as told:
            number = told.readline().strip()
        yield Display(kept | {"DISPLAY": f":{number}"}, folder / "Xvfb_screen0")
        process.terminate()


def run(display: Display, folder: Path, *words: str) -> tuple[str, int]:
    """Run Python on the display; what it printed, and the most colours that were ever shown [-]."""
    most, until = 0, time.monotonic() + PATIENCE
    with (folder / "printed.txt").open("w+") as printed:
        command = [sys.executable, *words]
        streams = {"stdout": printed, "stderr": subprocess.STDOUT}
        process = subprocess.Popen(command, cwd=folder, env=display.environment, **streams)
        try:
            while process.poll() is None:
                assert time.monotonic() < until, "it does not end"
                most = max(most, display.num_colours())
                time.sleep(0.05)
        finally:
            process.kill()
            process.wait()
        printed.seek(0)
        text = printed.read()
    assert process.returncode == 0, text
    return text, most


def test_mujocos_viewer_shows_a_drive_and_closes_at_its_end(
    display: Display, tmp_path: Path
) -> None:
    _, most = run(display, tmp_path, "-m", "mjdrive", "view", "--town", "town02", "--steps", "15")
    assert most > 100
    assert display.num_colours() < 10


def test_dm_controls_viewer_drives_restarts_and_closes(display: Display, tmp_path: Path) -> None:
    printed, most = run(display, tmp_path, "-c", DM_CONTROL)
    speeds = [float(word) for word in printed.split()]
    assert len(speeds) >= 16
    assert speeds[0] == speeds[8] == 0.0
    assert min(speeds[7], speeds[15]) > 0.5
    assert most > 100


def test_gymnasium_finds_nothing_to_complain_about_with_all_that_is_rendered(
    display: Display, tmp_path: Path
) -> None:
    printed, most = run(display, tmp_path, "-c", CHECK_ENV)
    assert printed == ""
    assert most > 100
