"""What the MPC is held to, on drives that are made up."""

import dataclasses

import numpy as np
import pytest

from mjdrive.evaluation.expert_bars import bars
from mjdrive.evaluation.expert_drives import Drive, Times

PID = Drive(
    "pid", "default", "town01", "route0", 0, steps=1000, jerk_rms=3.0, steering_unrest=0.8,
    steering_whiteness=0.1, offset_rms_m=0.3,
)  # fmt: skip
MPC = Drive(
    "mpc", "default", "town01", "route0", 0, steps=1000, jerk_rms=1.0, steering_unrest=0.2,
    steering_whiteness=0.04, offset_rms_m=0.1, wall=Times(mean_ms=4.0, p99_ms=9.0, max_ms=12.0),
)  # fmt: skip


def failed(*drives: Drive) -> list[str]:
    return [it.figure for it in bars(drives) if not it.holds]


def test_every_bar_of_the_issue_is_looked_at() -> None:
    assert [it.figure for it in bars([PID, MPC])] == [
        "mean time of a decision",
        "decisions over 50 ms, of 100",
        "mean CPU time of a decision",
        "99th percentile of CPU time, worst drive",
        "lane error of a drive, RMS",
        "jerk, of the PID's",
        "steering unrest, of the PID's",
        "steering whiteness, of the PID's",
    ]
    assert failed(PID, MPC) == []


@pytest.mark.parametrize(
    ("change", "figure"),
    [
        ({"wall": Times(mean_ms=20.1)}, "mean time of a decision"),
        ({"wall": Times(slow=11)}, "decisions over 50 ms, of 100"),
        ({"cpu": Times(mean_ms=20.1)}, "mean CPU time of a decision"),
        ({"cpu": Times(p99_ms=50.1)}, "99th percentile of CPU time, worst drive"),
        ({"offset_rms_m": 0.251}, "lane error of a drive, RMS"),
        ({"jerk_rms": 1.51}, "jerk, of the PID's"),
        ({"steering_unrest": 0.41}, "steering unrest, of the PID's"),
        ({"steering_whiteness": 0.051}, "steering whiteness, of the PID's"),
    ],
)
def test_bar_that_is_not_held_is_named(change: dict[str, object], figure: str) -> None:
    worse = dataclasses.replace(MPC, **change)
    assert failed(PID, worse) == [figure]
    (bar,) = [it for it in bars([PID, worse]) if not it.holds]
    assert str(bar).startswith(f"mpc town01: {figure}")
    assert "expected at most" in str(bar)
    assert bar.is_open == ("whiteness" in figure)


def test_only_drives_of_the_same_route_and_lights_are_compared() -> None:
    calm_elsewhere = dataclasses.replace(PID, seed=1, jerk_rms=0.1)
    assert failed(PID, calm_elsewhere, MPC) == []
    assert len(bars([calm_elsewhere, MPC])) == 5
    assert bars([PID]) == ()


def test_longer_drives_weigh_more() -> None:
    long = dataclasses.replace(MPC, route="route1", steps=3000, jerk_rms=2.0)
    twin = dataclasses.replace(PID, route="route1", steps=3000)
    jerk = next(it for it in bars([PID, twin, MPC, long]) if it.figure.startswith("jerk"))
    assert jerk.measured == pytest.approx(np.sqrt((1.0 + 3 * 4.0) / 4) / 3.0)


def test_drive_that_did_not_arrive_says_nothing_of_its_smoothness() -> None:
    lost = dataclasses.replace(MPC, route="route1", steps=0, jerk_rms=0.0, reason="lost")
    assert bars([PID, MPC, lost]) == bars([PID, MPC])
    assert lost.flaw == "lost"


def test_clock_decides_nothing_where_cpu_time_does() -> None:
    busy = dataclasses.replace(MPC, wall=Times(mean_ms=30.0, slow=100))
    for clock in ("wall", "cpu"):
        deciding = [
            it.figure for it in bars([busy], clock=clock) if not it.holds and not it.is_open
        ]
        assert len(deciding) == {"wall": 2, "cpu": 0}[clock]
