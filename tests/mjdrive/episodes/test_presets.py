import math

import pytest

from mjdrive.config import DisturbanceConfig
from mjdrive.episodes.presets import (
    chosen,
    collect_preset,
    route_names,
    with_noise,
    with_throttle_noise,
)
from mjdrive.errors import ConfigError, UnknownNameError


def test_paper_is_not_disturbed_and_drives_every_route() -> None:
    paper = collect_preset("paper")
    assert paper.disturbance is None
    assert paper.routes == ()


def test_quick_drives_fewer_routes_in_the_standard_way() -> None:
    quick, standard = collect_preset("quick"), collect_preset("standard")
    assert 0 < len(quick.routes) < 10
    assert quick.disturbance == standard.disturbance is not None


def test_unknown_preset_is_refused_with_the_nearest() -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'paper'"):
        collect_preset("papr")


def test_noise_scales_the_standard_disturbance() -> None:
    standard, half = DisturbanceConfig(), with_noise(collect_preset("paper"), 0.5).disturbance
    assert half is not None
    assert half.steering_amplitude == pytest.approx(0.5 * standard.steering_amplitude)
    assert half.stop_rate_per_min == pytest.approx(0.5 * standard.stop_rate_per_min)
    assert with_noise(collect_preset("paper"), 1.0).disturbance == standard


def test_no_noise_is_no_disturbance() -> None:
    assert with_noise(collect_preset("standard"), 0.0).disturbance is None


@pytest.mark.parametrize("scale", [-0.1, 2.1, math.nan, math.inf])
def test_impossible_noise_is_refused(scale: float) -> None:
    with pytest.raises(ConfigError, match=rf"^noise is {scale:g}; expected 0"):
        with_noise(collect_preset("standard"), scale)
    with pytest.raises(ConfigError, match=rf"^throttle noise is {scale:g}; expected 0"):
        with_throttle_noise(collect_preset("standard"), scale)


def test_throttle_noise_comes_on_top_and_alone() -> None:
    standard = DisturbanceConfig()
    on_top = chosen("standard", throttle_noise=1.5).disturbance
    assert on_top is not None
    assert on_top.throttle_amplitude == pytest.approx(1.5 * standard.throttle_amplitude)
    assert on_top.steering_rate_per_min == standard.steering_rate_per_min
    alone = chosen("standard", noise=0.0, throttle_noise=1.0).disturbance
    assert alone is not None
    assert (alone.steering_rate_per_min, alone.stop_rate_per_min) == (0.0, 0.0)
    assert alone.throttle_rate_per_min > 0
    assert chosen("standard", throttle_noise=0.0) == collect_preset("standard")


def test_what_is_not_chosen_is_as_the_preset_has_it() -> None:
    for preset in ("standard", "paper", "quick"):
        assert chosen(preset) == collect_preset(preset)


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("b", ("b",)),
        ("0", ("a",)),
        ("1-2", ("b", "c")),
        ("c, 0-1", ("c", "a", "b")),
    ],
)
def test_routes_are_named_or_numbered(text: str, names: tuple[str, ...]) -> None:
    assert route_names(text, ["a", "b", "c"]) == names


def test_routes_that_are_not_there_are_refused() -> None:
    known = ["route0", "route1"]
    with pytest.raises(UnknownNameError, match=r"Unknown route 'nope'\. Known: route0, route1"):
        route_names("route0,nope", known)
    with pytest.raises(UnknownNameError, match="Unknown route ''"):
        route_names("", known)
    for text in ("2", "0-2", "1-0"):
        with pytest.raises(ConfigError, match=rf"no routes '{text}'; expected numbers from 0 to 1"):
            route_names(text, known)
    with pytest.raises(ConfigError, match="expected each once"):
        route_names("route0,0-1", known)


def test_random_walk_takes_the_place_of_the_routes_of_a_preset() -> None:
    settings = chosen("quick", random_walk_km=2.0)
    assert (settings.routes, settings.random_walk_km) == ((), 2.0)
    with pytest.raises(ConfigError, match="follows no routes"):
        chosen("quick", random_walk_km=2.0, routes=("route0",))


@pytest.mark.parametrize("km", [0.0, -1.0, math.nan, math.inf])
def test_random_walk_without_a_length_is_refused(km: float) -> None:
    with pytest.raises(ConfigError, match=rf"random walk is {km:g} km; expected more than 0 km"):
        chosen("standard", random_walk_km=km)


def test_unknown_expert_is_refused() -> None:
    with pytest.raises(UnknownNameError, match=r"Unknown expert 'mcp'.*Did you mean 'mpc'"):
        chosen("standard", expert="mcp")
