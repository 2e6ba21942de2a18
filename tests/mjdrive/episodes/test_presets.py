import pytest

from mjdrive.config import DisturbanceConfig
from mjdrive.episodes.presets import collect_preset, with_noise
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


@pytest.mark.parametrize("scale", [-0.1, 3.0])
def test_impossible_noise_is_refused(scale: float) -> None:
    with pytest.raises(ConfigError, match="expected"):
        with_noise(collect_preset("standard"), scale)
