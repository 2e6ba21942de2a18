import numpy as np
import pytest

from mjdrive.config import RulesConfig
from mjdrive.datatypes import InfractionKind, Lane, Signal, Town, TrafficLight, VehicleState
from mjdrive.simulation.rules import Rules
from mjdrive.vehicle.parameters import VehicleParameters

LINE = 50.0
"""Where the stop line of the approach lies [m]."""


@pytest.fixture(scope="module")
def town() -> Town:
    approach = Lane(
        "approach", np.array([[0.0, 0.0], [LINE, 0.0]]), 4.0, ("beyond",), None, "light"
    )
    beyond = Lane("beyond", np.array([[LINE, 0.0], [100.0, 0.0]]), 4.0, (), "j", None)
    light = TrafficLight(
        "light",
        "approach",
        "j",
        np.array([[LINE, 2.0], [LINE, -2.0]]),
        0.0,
        np.array([LINE, -4.5]),
        ((Signal.RED, 10.0),),
        0.0,
    )
    lanes = {"approach": approach, "beyond": beyond}
    return Town("line", lanes, {"light": light}, np.array([0.0, -2.0, 100.0, 2.0]), "")


def centre_at(x: float, *, y: float = 0.0, yaw: float = 0.0) -> VehicleState:
    """State whose footprint is centred on (x, y)."""
    car = VehicleParameters.default()
    ahead = car.length / 2 - car.rear_overhang
    return VehicleState(x - ahead * np.cos(yaw), y - ahead * np.sin(yaw), yaw, 5.0, 0.0, 0.0)


def drive(rules: Rules, centres, *, signal=Signal.RED, y=0.0, yaw=0.0, hits=()):
    found = []
    for step, x in enumerate(centres):
        found += rules.check(
            time=0.1 * step, vehicle=centre_at(x, y=y, yaw=yaw), lights={"light": signal}, hits=hits
        )
    return found


def kinds(infractions) -> list[InfractionKind]:
    return [infraction.kind for infraction in infractions]


def rules(town: Town, **settings: float) -> Rules:
    return Rules(town, VehicleParameters.default(), RulesConfig(**settings))


def test_crossing_on_red_counts_once_and_names_the_light(town):
    (infraction,) = drive(rules(town), np.arange(40.0, 60.0, 0.5))
    assert infraction.kind is InfractionKind.RED_LIGHT
    assert infraction.cause == "light"


def test_guilt_begins_when_the_tail_reaches_the_line(town):
    half = VehicleParameters.default().length / 2
    innocent = (
        LINE + 0.8 * half - 0.05
    )  # nose far over the line, near end of the tail just before it
    assert drive(rules(town), [innocent]) == []
    assert kinds(drive(rules(town), [innocent + 0.1])) == [InfractionKind.RED_LIGHT]
    assert drive(rules(town), [LINE + half + 1.05]) == []


@pytest.mark.parametrize("signal", [Signal.GREEN, Signal.YELLOW])
def test_green_and_yellow_may_be_crossed(town, signal):
    assert drive(rules(town), np.arange(40.0, 60.0, 0.5), signal=signal) == []


def test_only_the_middle_of_the_line_is_watched(town):
    centres = np.arange(40.0, 60.0, 0.5)
    assert kinds(drive(rules(town), centres, y=1.55)) == [InfractionKind.RED_LIGHT]
    assert drive(rules(town), centres, y=1.65) == []
    assert kinds(drive(rules(town, stop_line_share=0.6), centres, y=1.65)) == [
        InfractionKind.RED_LIGHT
    ]


def test_oncoming_cars_cross_freely(town):
    assert drive(rules(town), np.arange(60.0, 40.0, -0.5), yaw=np.pi) == []


def test_leaving_the_road_counts_once_for_each_excursion(town):
    watch = rules(town)
    assert kinds(drive(watch, [20.0, 21.0, 22.0], y=2.3)) == [InfractionKind.OFF_ROAD]
    assert drive(watch, [23.0], y=1.4) == []
    assert kinds(drive(watch, [24.0], y=2.1)) == [InfractionKind.OFF_ROAD]


def test_touching_the_same_thing_counts_again_only_later_and_elsewhere(town):
    watch, pole = rules(town), (InfractionKind.COLLISION, "pole_1")
    at = lambda time, x: watch.check(  # noqa: E731
        time=time, vehicle=centre_at(x), lights={"light": Signal.GREEN}, hits=[pole]
    )
    assert kinds(at(0.0, 10.0)) == [InfractionKind.COLLISION]
    assert at(1.0, 20.0) == ()  # elsewhere, but within 5 s
    assert at(9.0, 21.0) == ()  # later, but within 3 m of the last touch
    assert kinds(at(20.0, 30.0)) == [InfractionKind.COLLISION]


def test_reset_forgets_the_light_that_was_run(town):
    watch = rules(town)
    drive(watch, np.arange(40.0, 60.0, 0.5))
    watch.reset()
    assert kinds(drive(watch, np.arange(40.0, 60.0, 0.5))) == [InfractionKind.RED_LIGHT]


def test_a_tyre_on_a_kerb_does_not_hide_the_body_on_it(town):
    watch = rules(town)
    tyre, body = (InfractionKind.KERB, "kerb"), (InfractionKind.COLLISION, "kerb")
    found = drive(watch, [20.0], signal=Signal.GREEN, hits=[tyre])
    found += drive(watch, [20.5], signal=Signal.GREEN, hits=[tyre, body])
    assert kinds(found) == [InfractionKind.KERB, InfractionKind.COLLISION]
