"""Towns and simulations that many tests share, and scripts as modules; a simulation is reset by whoever uses it."""

import importlib.util
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType

import pytest

from mjdrive.datatypes import Town
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library

SCRIPTS = Path(__file__).resolve().parents[1] / "scripts"


@pytest.fixture(scope="session", autouse=True)
def _heed_ctrl_c() -> Iterator[None]:
    """Let tests send SIGINT even where a shell, which started them in the background, has it ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(scope="session")
def town01() -> Town:
    return library.load("town01")


@pytest.fixture(scope="session")
def town02() -> Town:
    return library.load("town02")


@pytest.fixture(scope="session")
def simulation(town02: Town) -> Simulation:
    return Simulation(town02)


@pytest.fixture
def load_script() -> Iterator[Callable[[str], ModuleType]]:
    """Loads a script by name; as `__main__`, it can be imported nowhere else."""
    loaded = []

    def load(name: str) -> ModuleType:
        spec = importlib.util.spec_from_file_location(f"script_{name}", SCRIPTS / f"{name}.py")
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[spec.name] = module
        loaded.append(spec.name)
        spec.loader.exec_module(module)
        return module

    yield load
    for name in loaded:
        del sys.modules[name]
