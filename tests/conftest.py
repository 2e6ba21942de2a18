"""Towns and simulations that many tests share; a simulation is reset by whoever uses it."""

import pytest

from mjdrive.datatypes import Town
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library


@pytest.fixture(scope="session")
def town01() -> Town:
    return library.load("town01")


@pytest.fixture(scope="session")
def town02() -> Town:
    return library.load("town02")


@pytest.fixture(scope="session")
def simulation(town02: Town) -> Simulation:
    return Simulation(town02)
