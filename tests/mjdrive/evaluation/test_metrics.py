import dataclasses
import json
from collections.abc import Callable

import numpy as np
import pytest

from mjdrive import config
from mjdrive.datatypes import Episode, Infraction, InfractionKind, Town
from mjdrive.evaluation import metrics

Make = Callable[..., Episode]


def infraction(kind: InfractionKind, time: float = 1.0) -> Infraction:
    return Infraction(kind, time, 0.0, 0.0, "")


def test_distance_and_duration_of_a_straight_drive(crossing: Town, make_drive: Make) -> None:
    summary = metrics.summarise(make_drive(np.linspace(0.0, 100.0, 201)), crossing)
    assert (summary.steps, summary.duration_s, summary.distance_m) == (201, 20.1, 100.0)
    assert summary.score == 100.0


def test_metres_off_the_lanes_do_not_count(crossing: Town, make_drive: Make) -> None:
    on_lane = np.ones(101, bool)
    on_lane[40:60] = False
    summary = metrics.summarise(make_drive(np.linspace(0.0, 100.0, 101), on_lane=on_lane), crossing)
    assert summary.distance_m == pytest.approx(100.0 - 21.0)  # 20 steps and the one that left
    assert summary.off_road_s == pytest.approx(2.0)


def test_each_red_light_takes_three_tenths_of_the_score(crossing: Town, make_drive: Make) -> None:
    infractions = (
        infraction(InfractionKind.RED_LIGHT, 1.0),
        infraction(InfractionKind.COLLISION, 2.0),
        infraction(InfractionKind.RED_LIGHT, 3.0),
        infraction(InfractionKind.KERB, 4.0),
        infraction(InfractionKind.KERB, 5.0),
        infraction(InfractionKind.KERB, 6.0),
    )
    summary = metrics.summarise(
        make_drive(np.linspace(0.0, 100.0, 101), infractions=infractions), crossing
    )
    assert (summary.red_lights, summary.collisions, summary.kerb_strikes) == (2, 1, 3)
    assert summary.score == pytest.approx(0.49 * summary.distance_m)


def test_waiting_at_red_is_not_being_stuck(crossing: Town, make_drive: Make) -> None:
    waiting = make_drive(np.full(100, 36.0), light_phase=15.0)
    assert metrics.summarise(waiting, crossing).stuck_s == 0.0
    assert metrics.waits_at_light(waiting, crossing).all()


def test_standing_at_green_is_being_stuck(crossing: Town, make_drive: Make) -> None:
    standing = make_drive(np.full(150, 36.0))  # green for 10 s, then yellow
    assert metrics.summarise(standing, crossing).stuck_s == pytest.approx(10.0)


@pytest.mark.parametrize(
    "where",
    [{"x": 10.0}, {"x": 41.0}, {"x": 36.0, "y": 4.0}, {"x": 36.0, "yaw": np.pi}],
    ids=["far before", "past the line", "beside the lane", "other direction"],
)
def test_only_a_car_before_the_line_waits(
    crossing: Town, make_drive: Make, where: dict[str, float]
) -> None:
    drive = make_drive(np.full(10, where.pop("x")), light_phase=20.0, **where)
    assert not metrics.waits_at_light(drive, crossing).any()


def test_straight_and_left_are_told_apart(crossing: Town, make_drive: Make) -> None:
    straight = make_drive(np.linspace(0.0, 100.0, 201))
    assert metrics.summarise(straight, crossing).branches_taken == {"straight": 1}
    angle = np.linspace(0.0, np.pi / 2, 60)
    x = np.concatenate([np.linspace(0, 40, 81)[:-1], 40 + 20 * np.sin(angle)])
    y = np.concatenate([np.zeros(80), 20 - 20 * np.cos(angle)])
    yaw = np.concatenate([np.zeros(80), angle])
    left = metrics.summarise(make_drive(x, y=y, yaw=yaw), crossing)
    assert left.branches_taken == {"left": 1}


def test_a_second_lap_counts_again(crossing: Town, make_drive: Make) -> None:
    lap = np.linspace(0.0, 100.0, 201)
    summary = metrics.summarise(make_drive(np.concatenate([lap, lap])), crossing)
    assert summary.branches_taken == {"straight": 2}


def test_turning_back_in_the_junction_is_no_branch(crossing: Town, make_drive: Make) -> None:
    there = np.linspace(0.0, 50.0, 101)
    yaw = np.concatenate([np.zeros(101), np.full(101, np.pi)])
    drive = make_drive(np.concatenate([there, there[::-1]]), yaw=yaw)
    assert metrics.summarise(drive, crossing).branches_taken == {}


@pytest.mark.parametrize("steps", [0, 1])
def test_short_drives_have_a_summary(crossing: Town, make_drive: Make, steps: int) -> None:
    summary = metrics.summarise(make_drive(np.zeros(steps)), crossing)
    assert (summary.steps, summary.distance_m) == (steps, 0.0)


def test_summary_is_json_with_units_in_its_keys(crossing: Town, make_drive: Make) -> None:
    summary = metrics.summarise(make_drive(np.linspace(0.0, 100.0, 101)), crossing)
    values = json.loads(config.to_json(summary))
    assert values["versions"] == {"mjdrive": "0.1.0"}
    for field in dataclasses.fields(summary):
        if field.type is float and field.name != "score":
            assert field.name.endswith(("_s", "_m")), field.name
    assert all(name.endswith(("_m", "_rad")) for name in values["lane_keeping"])
    assert values["lane_keeping"]["offset_mean_m"] == 0.0


@pytest.mark.parametrize(
    ("kind", "field"),
    [
        (InfractionKind.RED_LIGHT, "red_lights"),
        (InfractionKind.COLLISION, "collisions"),
        (InfractionKind.KERB, "kerb_strikes"),
        (InfractionKind.OFF_ROAD, "road_departures"),
        (InfractionKind.WRONG_WAY, "wrong_ways"),
        (InfractionKind.STUCK, "standstills"),
    ],
)
def test_each_kind_of_infraction_has_a_count_of_its_own(
    crossing: Town, make_drive: Make, kind: InfractionKind, field: str
) -> None:
    names = (
        "red_lights", "collisions", "kerb_strikes", "road_departures", "wrong_ways", "standstills"
    )  # fmt: skip
    infractions = (infraction(kind, 1.0), infraction(kind, 2.0))
    summary = metrics.summarise(
        make_drive(np.linspace(0.0, 50.0, 51), infractions=infractions), crossing
    )
    assert {name: getattr(summary, name) for name in names} == dict.fromkeys(names, 0) | {field: 2}
