"""What becomes of a run whose cluster keeps silent."""

import logging

import pytest

from mjdrive.errors import ClusterError
from mjdrive.execution.patience import SILENCE, Patience


class Clock:
    time = 100.0

    def __call__(self) -> float:
        return self.time


@pytest.fixture
def clock() -> Clock:
    return Clock()


def test_a_cluster_that_lost_its_cores_is_given_up_after_a_silence(clock: Clock) -> None:
    patience = Patience(clock)
    clock.time += SILENCE - 1.0
    patience.wait(num_cores=0.0)
    patience.hear()
    clock.time += SILENCE - 1.0
    patience.wait(num_cores=0.0)
    clock.time += 1.0
    with pytest.raises(ClusterError, match=r"for 60 s, and it has no core left.*goes on from here"):
        patience.wait(num_cores=0.0)


def test_of_a_busy_cluster_one_line_is_said_in_each_silence(
    clock: Clock, caplog: pytest.LogCaptureFixture
) -> None:
    patience = Patience(clock)
    with caplog.at_level(logging.WARNING):
        for _ in range(2):
            patience.hear()
            for _ in range(5):
                clock.time += SILENCE
                patience.wait(num_cores=8.0)
    assert len(caplog.messages) == 2
    assert "its 8 cores may be busy" in caplog.messages[0]
