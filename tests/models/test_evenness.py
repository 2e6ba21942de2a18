import dataclasses

import pytest
import torch

from models.config import EvennessConfig
from models.epoch_order import EpochOrder
from models.errors import SettingError
from models.evenness import speed_weights
from models.presets import quick

NUM_PAIRS = 4000


def _speeds() -> torch.Tensor:
    """A third of them waits, half of them cruises, the rest lies in between [m/s]."""
    generator = torch.Generator().manual_seed(0)
    unit = torch.rand(NUM_PAIRS, generator=generator)
    between = 6.0 * torch.rand(NUM_PAIRS, generator=generator)
    return torch.where(unit < 0.33, 0.0, torch.where(unit < 0.83, 6.0, between))


def test_without_an_exponent_all_pairs_weigh_alike() -> None:
    assert (speed_weights(_speeds(), EvennessConfig()) == 1).all()


def test_pairs_of_one_speed_weigh_alike() -> None:
    weights = speed_weights(torch.full((10,), 3.0), EvennessConfig(speed_exponent=1.0))
    torch.testing.assert_close(weights, torch.ones(10))


def test_with_exponent_one_each_range_of_speeds_gets_its_share() -> None:
    speeds = _speeds()
    weights = speed_weights(speeds, EvennessConfig(speed_exponent=1.0, speed_bandwidth=0.1))
    assert weights.mean() == pytest.approx(1.0, abs=1e-5)
    for low, high in ((1.0, 2.0), (2.0, 3.0), (3.0, 5.0)):
        inside = (speeds >= low) & (speeds < high)
        share, others = weights[inside].sum() / (high - low), weights.sum() / 6.0
        assert share == pytest.approx(float(others), rel=0.15)


def test_more_exponent_gives_rare_speeds_more_weight() -> None:
    speeds = _speeds()
    rare = (speeds > 1.0) & (speeds < 5.0)
    shares = [
        float(speed_weights(speeds, EvennessConfig(speed_exponent=power))[rare].sum())
        for power in (0.0, 0.4, 0.8)
    ]
    assert shares == sorted(shares)
    assert shares[2] > 2 * shares[0]


def test_an_epoch_draws_rare_speeds_more_often_and_leaves_what_is_done_at_them() -> None:
    speeds = _speeds()
    generator = torch.Generator().manual_seed(1)
    brakes = torch.rand(NUM_PAIRS, generator=generator) < torch.where(speeds == 0, 0.9, 0.2)
    config = dataclasses.replace(quick("bc-beta"), evenness=EvennessConfig(speed_exponent=1.0))
    order = EpochOrder(config, 0, speeds, torch.ones(NUM_PAIRS))
    drawn = torch.cat([order.of(epoch) for epoch in range(5)])
    stands = speeds[drawn] == 0
    assert stands.float().mean() < 0.2
    assert brakes[drawn][stands].float().mean() == pytest.approx(0.9, abs=0.03)
    assert brakes[drawn][~stands].float().mean() == pytest.approx(0.2, abs=0.03)


@pytest.mark.parametrize("given", [{"speed_exponent": -1.0}, {"speed_bandwidth": 0.0}])
def test_settings_without_a_meaning_are_refused(given: dict[str, float]) -> None:
    with pytest.raises(SettingError, match=next(iter(given))):
        EvennessConfig(**given)


def test_a_speed_that_is_not_seen_cannot_be_evened_out() -> None:
    blind = dataclasses.replace(quick("da-ibc").network, state_inputs=())
    config = dataclasses.replace(quick("da-ibc"), network=blind)
    with pytest.raises(SettingError, match=r"speed_exponent is 0.8; expected 0"):
        dataclasses.replace(config, evenness=EvennessConfig(speed_exponent=0.8))
