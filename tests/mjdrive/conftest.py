"""A drive of a second and a half, for whoever shows, sends or takes drives."""

from pathlib import Path

import pytest

from mjdrive.cli.driver import find_driver
from mjdrive.datatypes import Episode, Town
from mjdrive.simulation.simulation import Simulation


@pytest.fixture(scope="session")
def short_drive(town02: Town) -> Episode:
    """Fifteen steps of the PID expert in town02, as `mjdrive drive` records them."""
    driver = find_driver("pid", Path("runs"))
    return driver.drive(Simulation(town02), num_steps=15, seed=3, on_step=lambda done: None)
