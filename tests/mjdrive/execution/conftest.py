"""Lets other processes find the work that these tests give them."""

import os
import sys
from pathlib import Path

import pytest

HERE = str(Path(__file__).parent)
sys.path.insert(0, HERE)

from squares import Squares  # noqa: E402


@pytest.fixture(autouse=True)
def findable(monkeypatch: pytest.MonkeyPatch) -> None:
    others = os.environ.get("PYTHONPATH")
    monkeypatch.setenv("PYTHONPATH", HERE if not others else os.pathsep.join((HERE, others)))


@pytest.fixture
def squares(tmp_path: Path) -> Squares:
    folder = tmp_path / "notes"
    folder.mkdir()
    return Squares(folder)
