"""The page is in the wheel, and the installed wheel serves it far from the checkout."""

import json
import re
import signal
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest

from mjdrive.page.built import FOLDER as PAGE

PATIENCE = 120.0
"""For the server to start on a busy machine [s]."""


@pytest.fixture(scope="module")
def server(
    environment: dict[str, str], tmp_path_factory: pytest.TempPathFactory
) -> Iterator[tuple[str, "subprocess.Popen[bytes]"]]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    words = ["serve", "--town", "town03", "--policy", "pid", "--port", str(port)]
    command = [sys.executable, "-m", "mjdrive", *words]
    folder = tmp_path_factory.mktemp("far_away")
    with subprocess.Popen(command, cwd=folder, env=environment) as process:
        address, until = f"http://127.0.0.1:{port}/", time.monotonic() + PATIENCE
        while process.poll() is None and time.monotonic() < until:
            try:
                fetched(address + "api/health")
                break
            except OSError:
                time.sleep(0.2)
        yield address, process
        process.kill()


def fetched(address: str) -> bytes:
    with urllib.request.urlopen(address, timeout=PATIENCE) as answer:
        return bytes(answer.read())


def test_the_wheel_holds_the_page_as_it_was_built(installed: Path) -> None:
    built = {it.relative_to(PAGE): it.read_bytes() for it in PAGE.rglob("*") if it.is_file()}
    there = installed / "mjdrive" / "page" / "static"
    found = {it.relative_to(there): it.read_bytes() for it in there.rglob("*") if it.is_file()}
    assert found == built
    assert not (installed / "mjdrive" / "page" / "browser").exists()  # users need no Node


def test_the_installed_wheel_is_what_runs(environment: dict[str, str], installed: Path) -> None:
    command = [sys.executable, "-c", "import mjdrive; print(mjdrive.__file__)"]
    found = subprocess.run(
        command, cwd=installed, env=environment, check=True, text=True, capture_output=True
    )
    assert Path(found.stdout.strip()).is_relative_to(installed)


def test_the_installed_wheel_serves_the_page_and_drives(
    server: tuple[str, "subprocess.Popen[bytes]"],
) -> None:
    address, process = server
    page = fetched(address).decode()
    files = re.findall(r'(?:src|href)="\.?/?([^":]+\.(?:js|css))"', page)
    assert len(files) >= 2
    assert all(fetched(address + name) == (PAGE / name).read_bytes() for name in files)
    assert "town03" in json.loads(fetched(address + "api/catalogue"))["towns"]
    steps = json.loads(fetched(address + "api/health"))["steps"]
    until = time.monotonic() + PATIENCE
    while json.loads(fetched(address + "api/health"))["steps"] <= steps:
        assert time.monotonic() < until
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    assert process.wait(PATIENCE) == 0
