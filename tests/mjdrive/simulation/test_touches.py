"""Collisions and kerb strikes, at the edges of what is a new event."""

import pytest

from mjdrive.config import RulesConfig
from mjdrive.datatypes import InfractionKind
from mjdrive.simulation.touches import TouchWatch

POLE, WALL = (InfractionKind.COLLISION, "pole_1"), (InfractionKind.COLLISION, "building_2")
TYRE, BODY = (InfractionKind.KERB, "kerb"), (InfractionKind.COLLISION, "kerb")

Steps = list[tuple[float, float, list[tuple[InfractionKind, str]]]]


def events(steps: Steps, **settings: float) -> list[tuple[float, str, str]]:
    """Time, kind and name of each new event of a drive given as times [s], places [m] and touches."""
    watch = TouchWatch(RulesConfig(**settings))
    return [
        (time, kind.name, name)
        for time, x, touches in steps
        for kind, name in watch.check(time, (x, 0.0), touches)
    ]


def scrape(length: float, *, speed: float = 5.0) -> Steps:
    """Along a wall without losing touch."""
    return [(0.1 * step, 0.1 * speed * step, [WALL]) for step in range(round(10 * length / speed))]


@pytest.mark.parametrize(
    ("steps", "expected"),
    [
        pytest.param([(0.0, 0.0, [POLE])], [0.0], id="once"),
        pytest.param([(0.0, 0.0, [])], [], id="nothing"),
        pytest.param([(0.1 * n, 0.0, [POLE]) for n in range(600)], [0.0], id="leans on it 60 s"),
        pytest.param(scrape(100.0), [0.0], id="scrapes along it for 100 m"),
        pytest.param([(0.0, 0.0, [POLE]), (4.9, 9.0, [POLE])], [0.0], id="far off after 4.9 s"),
        pytest.param([(0.0, 0.0, [POLE]), (5.1, 2.9, [POLE])], [0.0], id="2.9 m off after 5.1 s"),
        pytest.param(
            [(0.0, 0.0, [POLE]), (5.1, 3.1, [POLE])], [0.0, 5.1], id="3.1 m off after 5.1 s"
        ),
        pytest.param([(0.0, 0.0, [POLE]), (60.0, 0.0, [POLE])], [0.0], id="same place much later"),
        pytest.param(
            [(0.0, 0.0, [POLE]), (4.0, 2.0, [POLE]), (8.0, 4.0, [POLE])],
            [0.0],
            id="time and distance run from the last touch",
        ),
        pytest.param(
            [(0.0, 0.0, [POLE]), (9.0, 9.0, [POLE]), (18.0, 18.0, [POLE])],
            [0.0, 9.0, 18.0],
            id="three times",
        ),
    ],
)
def test_touches_of_one_thing(steps: Steps, expected: list[float]) -> None:
    assert [time for time, _, _ in events(steps)] == expected


@pytest.mark.parametrize(
    ("steps", "expected"),
    [
        pytest.param(
            [(0.0, 0.0, [POLE, WALL])],
            [(0.0, "COLLISION", "pole_1"), (0.0, "COLLISION", "building_2")],
            id="both at once",
        ),
        pytest.param(
            [(0.0, 0.0, [POLE]), (0.1, 0.5, [WALL]), (0.2, 1.0, [POLE])],
            [(0.0, "COLLISION", "pole_1"), (0.1, "COLLISION", "building_2")],
            id="in turn",
        ),
        pytest.param(
            [(0.0, 0.0, [TYRE]), (0.1, 0.5, [TYRE, BODY]), (0.2, 1.0, [TYRE, BODY])],
            [(0.0, "KERB", "kerb"), (0.1, "COLLISION", "kerb")],
            id="the tyre on a kerb, then the body",
        ),
        pytest.param([(0.0, 0.0, [TYRE])], [(0.0, "KERB", "kerb")], id="the tyre on a kerb alone"),
    ],
)
def test_touches_of_two_things(steps: Steps, expected: list[tuple[float, str, str]]) -> None:
    assert events(steps) == expected


def test_limits_are_settings() -> None:
    steps: Steps = [(0.0, 0.0, [POLE]), (1.0, 2.0, [POLE])]
    assert len(events(steps)) == 1
    assert len(events(steps, same_hit_time=0.5, same_hit_distance=1.0)) == 2
