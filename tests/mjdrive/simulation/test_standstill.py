"""Being stuck, at the edges of the definition: 180 s below 0.1 m/s."""

import pytest

from mjdrive.config import RulesConfig
from mjdrive.simulation.standstill import StandstillWatch

STANDS, DRIVES = 0.0, 5.0


def stuck_at(*stretches: tuple[float, float], **settings: float) -> list[float]:
    """Times at which a drive is found stuck; it is given as durations [s] and speeds [m/s] in turn."""
    watch = StandstillWatch(RulesConfig(**settings))
    found, step = [], 0
    for duration, speed in stretches:
        for _ in range(
            round(10 * duration) + 1
        ):  # so many intervals lie between the first and the last
            if watch.check(0.1 * step, speed) is not None:
                found.append(round(0.1 * step, 1))
            step += 1
    return found


@pytest.mark.parametrize(
    ("stretches", "expected"),
    [
        pytest.param([(179.9, STANDS)], [], id="179.9 s"),
        pytest.param([(180.1, STANDS)], [180.0], id="180.1 s"),
        pytest.param([(600.0, STANDS)], [180.0], id="600 s count once"),
        pytest.param([(200.0, 0.09)], [180.0], id="creeps at 0.09 m/s"),
        pytest.param([(200.0, 0.11)], [], id="creeps at 0.11 m/s"),
        pytest.param([(200.0, -0.09)], [180.0], id="rolls back at 0.09 m/s"),
        pytest.param([(200.0, -0.11)], [], id="rolls back at 0.11 m/s"),
        pytest.param([(100.0, STANDS), (1.0, DRIVES), (100.0, STANDS)], [], id="moves in between"),
        pytest.param(
            [(200.0, STANDS), (0.9, DRIVES), (200.0, STANDS)], [180.0, 382.1 - 1.0], id="twice"
        ),
        pytest.param([(32.0, STANDS), (5.0, DRIVES)] * 10, [], id="waits at ten red lights"),
    ],
)
def test_standing(stretches: list[tuple[float, float]], expected: list[float]) -> None:
    assert stuck_at(*stretches) == pytest.approx(expected)


def test_limits_are_settings() -> None:
    assert stuck_at((95.0, 0.4), stuck_time=90.0, stuck_speed=0.5) == [90.0]


def test_the_cause_is_named() -> None:
    watch = StandstillWatch(RulesConfig(stuck_time=1.0))
    assert [watch.check(0.5 * step, 0.0) for step in range(4)] == [None, None, "standstill", None]
