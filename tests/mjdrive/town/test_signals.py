import dataclasses
import gc
from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.datatypes import Signal, Town
from mjdrive.town import library, signals

TIMES = np.arange(0.05, 180.0, 0.1)  # whole cycles of junctions with three streets and with four


@pytest.mark.parametrize("name", library.shipped_names())
def test_each_approach_has_its_share_of_the_cycle(name: str) -> None:
    town = library.load(name)
    streets = Counter(light.junction for light in town.lights.values())
    assert signals.cycle(town) == 15.0 * max(streets.values())
    for light in town.lights.values():
        num_tenths = 150 * streets[light.junction]
        shown = Counter(signals.at(light, (tenth + 0.5) / 10.0) for tenth in range(num_tenths))
        assert shown == {Signal.GREEN: 100, Signal.YELLOW: 30, Signal.RED: num_tenths - 130}


@pytest.mark.parametrize("name", library.shipped_names())
def test_at_most_one_approach_of_a_junction_may_go(name: str) -> None:
    town = library.load(name)
    all_red = Counter[str]()
    for time in TIMES:
        shown = signals.all_at(town, time)
        open_lights = Counter(
            town.lights[light].junction for light, signal in shown.items() if signal != Signal.RED
        )
        assert set(open_lights.values()) <= {1}
        all_red.update({light.junction for light in town.lights.values()} - set(open_lights))
    assert set(all_red.values()) == {240}  # twelve times 2 s


def test_approaches_turn_green_in_the_order_of_the_controllers(ladder: Town) -> None:
    lights = [light for light in ladder.lights.values() if light.junction == "20"]
    for turn, light in enumerate(lights):
        start = 15.0 * turn
        assert signals.at(light, start - 0.01) == Signal.RED
        assert signals.at(light, start) == Signal.GREEN
        assert signals.at(light, start + 10.0) == Signal.YELLOW
        assert signals.at(light, start + 13.0) == Signal.RED


@pytest.mark.parametrize("name", library.shipped_names())
def test_all_lights_show_what_each_shows_in_the_order_of_the_town(name: str) -> None:
    town = library.load(name)
    for time in TIMES[::37]:
        each = {light: signals.at(town.lights[light], time) for light in town.lights}
        assert list(signals.all_at(town, time).items()) == list(each.items())


@given(time=st.integers(-10_000, 10_000), turns=st.integers(-5, 5))
def test_lights_repeat_after_a_cycle(time: int, turns: int) -> None:
    town = library.load("town02")
    assert signals.all_at(town, 0.5 * time) == signals.all_at(town, 0.5 * time + 45.0 * turns)


def test_the_phase_is_a_pure_uniform_function_of_the_seed(ladder: Town) -> None:
    phases = np.array([signals.phase(ladder, seed) for seed in range(400)])
    assert [signals.phase(ladder, seed) for seed in range(400)] == list(phases)
    assert phases.min() >= 0.0
    assert phases.max() < 45.0
    counts, _ = np.histogram(phases, bins=4, range=(0.0, 45.0))
    assert counts.min() > 70  # 100 expected, standard deviation 8.7


def test_towns_that_nobody_uses_any_more_are_let_go() -> None:
    towns = [dataclasses.replace(library.load("town02")) for _ in range(20)]
    for town in towns:
        for time in range(0, 60, 5):
            signals.all_at(town, float(time))
    addresses = {id(town) for town in towns}
    del towns, town
    gc.collect()
    alive = [it for it in gc.get_objects() if type(it) is Town and id(it) in addresses]
    assert len(alive) <= 4


def test_no_more_states_are_kept_than_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(signals, "_MOST_KEPT", 2)
    town = dataclasses.replace(library.load("town02"))
    for time in TIMES[::37]:
        each = {light: signals.at(town.lights[light], time) for light in town.lights}
        assert signals.all_at(town, time) == each
        assert signals.all_at(town, time) is signals.all_at(town, time)
