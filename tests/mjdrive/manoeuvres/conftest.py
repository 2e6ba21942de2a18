import pytest

from mjdrive.manoeuvres import handling
from mjdrive.manoeuvres.handling import Handling
from mjdrive.manoeuvres.rig import Rig
from mjdrive.manoeuvres.single_track import SingleTrack


@pytest.fixture
def rig() -> Rig:
    return Rig.of_car()


@pytest.fixture(scope="session")
def track() -> SingleTrack:
    return Rig.of_car().single_track


@pytest.fixture(scope="session")
def driven() -> Handling:
    """All manoeuvres on the plane, once: ten seconds."""
    return handling.measure()
