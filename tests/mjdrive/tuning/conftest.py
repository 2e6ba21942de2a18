import pytest

from mjdrive.expert.pid import PidExpert
from mjdrive.tuning.course import Exercise, Trace, course, drive


@pytest.fixture(scope="session")
def exercises02(town02) -> tuple[Exercise, ...]:
    return course(town02, bends=12)


@pytest.fixture(scope="session")
def traces02(simulation, exercises02) -> tuple[Trace, ...]:
    """The tightest bend and the start beside the lane, driven by the PID."""
    expert = PidExpert(simulation.town)
    return tuple(drive(simulation, one, expert) for one in (exercises02[0], exercises02[-1]))
