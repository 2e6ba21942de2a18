"""Towns and simulations that many tests share; a simulation is reset by whoever uses it."""

import signal
from collections.abc import Iterator

import pytest

from mjdrive.datatypes import Town
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library


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
