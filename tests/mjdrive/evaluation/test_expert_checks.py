"""Experts are watched without being disturbed."""

import json

import numpy as np

from mjdrive.config import from_dict
from mjdrive.datatypes import Action, Route, Situation, VehicleState
from mjdrive.evaluation.expert_checks import Checker, WatchedExpert
from mjdrive.evaluation.expert_drives import Checks, Drive, Job, Times

CHECKS = Checks("c0de", "ca4", {"town01": "t0"}, {"processor": "one", "versions": {"numpy": "2"}})


class Slow:
    """Turns left a little more each time, and burns some time."""

    name = "slow"

    def reset(self, seed: int) -> None:
        self.count = seed

    def act(self, view: Situation) -> Action:
        self.count += sum(1 for _ in range(20_000)) // 20_000
        return Action(0.0, 0.01 * self.count)


def test_watched_expert_drives_as_it_would_alone() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0]])
    route = Route(("a",), points, points[:, 0], np.zeros(2), np.zeros(2), np.zeros(2, int))
    here = Situation(0.0, VehicleState(0.0, 0.0, 0.0, 1.0, 0.0, 0.0), route, 0.0, -0.2, {})
    watched = WatchedExpert(Slow())
    assert watched.name == "slow"
    watched.reset(3)
    assert [watched.act(here).steering for _ in range(2)] == [0.04, 0.05]
    assert watched.offset == [-0.2, -0.2]
    assert len(watched.wall) == len(watched.cpu) == 2
    assert min(watched.wall) > 0


def test_times_are_summed_up_in_milliseconds() -> None:
    times = Times.of(np.array([0.01] * 98 + [0.051, 0.06]))
    assert (times.mean_ms, times.max_ms, times.slow) == (10.91, 60.0, 2)
    assert 50.0 < times.p99_ms < 60.0


def test_file_of_drives_can_be_read_again() -> None:
    drive = Drive("mpc", "default", "town01", "route0", 3, steps=9, infractions=("red_light (a)",),
                  solver="fatrop", solves={"solved": 9})  # fmt: skip
    checks = Checks(**{**vars(CHECKS), "drives": (drive, drive)})
    assert from_dict(Checks, json.loads(checks.to_text())) == checks
    assert sum(line.startswith('{"expert"') for line in checks.to_text().splitlines()) == 2


def test_mpc_is_measured_while_it_drives() -> None:
    checker = Checker()
    drive = checker(Job("mpc", "default", "town01", "route1", 1), lambda done: None)
    assert drive.flaw == ""
    assert drive.solves["solved"] > 500
    assert drive.offset_rms_m < 0.25
    assert drive.offset_rms_m < drive.offset_max_m < 0.7
    assert 0 < drive.cpu.mean_ms < 20
    assert 0 < drive.jerk_rms < 3
    assert 0 < drive.steering_whiteness < drive.steering_unrest
