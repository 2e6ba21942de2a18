import dataclasses

import pytest
import torch

from models.config import NetworkConfig
from models.encoder import Encoder, draw_dropout, drop_previous_action
from models.learners import build_learner
from models.presets import paper


@pytest.mark.parametrize(
    ("method", "num_parameters"),
    [("bc-beta", 1_391_204), ("ibc", 1_390_945), ("da-ibc", 1_390_945)],
)
def test_networks_have_the_size_of_the_papers_predecessor(method, num_parameters):
    learner = build_learner(paper(method), seed=0)
    assert sum(parameter.numel() for parameter in learner.parameters()) == num_parameters


@pytest.mark.parametrize(("fusion", "feature_size"), [("roach", 256), ("separate", 512)])
def test_fusion_sets_the_number_of_features(fusion, feature_size, batch):
    encoder = Encoder(NetworkConfig(fusion=fusion))
    assert encoder(batch.bev[:2], batch.state[:2]).shape == (2, feature_size)


def test_excluded_state_inputs_change_nothing(batch):
    encoder = Encoder(NetworkConfig(state_inputs=("speed",)))
    other = batch.state.clone()
    other[:, 1:] += 0.5
    features = encoder(batch.bev, batch.state)
    torch.testing.assert_close(encoder(batch.bev, other), features, rtol=0, atol=0)
    other[:, 0] += 0.5
    assert not torch.equal(encoder(batch.bev, other), features)


def test_lights_of_before_change_nothing_where_no_history_is_seen(batch):
    blind, seeing = Encoder(NetworkConfig(light_history=False)), Encoder(NetworkConfig())
    seeing.load_state_dict(blind.state_dict())
    other = batch.bev.clone()
    other[:, 2:4] = 255 - other[:, 2:4]
    features = blind(batch.bev, batch.state)
    torch.testing.assert_close(blind(other, batch.state), features, rtol=0, atol=0)
    assert not torch.equal(seeing(other, batch.state), seeing(batch.bev, batch.state))
    other[:, 4] = 255 - other[:, 4]
    assert not torch.equal(blind(other, batch.state), features)


def test_speed_is_fed_in_as_a_share_of_its_scale(batch):
    scaled, plain = Encoder(NetworkConfig(speed_scale=10.0)), Encoder(NetworkConfig())
    plain.load_state_dict(scaled.state_dict())
    tenfold = batch.state * torch.tensor([10.0, 1.0, 1.0])
    torch.testing.assert_close(scaled(batch.bev, tenfold), plain(batch.bev, batch.state))


def test_dropped_previous_actions_are_zero_and_speed_is_kept(generator):
    state = torch.ones(2000, 3)
    dropped = drop_previous_action(state, draw_dropout(2000, 0.3, generator=generator))
    assert (dropped[:, 0] == 1).all()
    assert (dropped[:, 1] == dropped[:, 2]).all()
    assert (dropped[:, 1] == 0).float().mean().item() == pytest.approx(0.3, abs=0.04)


def test_the_seed_alone_sets_the_first_weights():
    config = paper("bc-beta")
    torch.manual_seed(1)
    first = build_learner(config, seed=5).state_dict()
    untouched = torch.rand(3)
    torch.manual_seed(1)
    torch.testing.assert_close(torch.rand(3), untouched)
    again = build_learner(dataclasses.replace(config), seed=5).state_dict()
    assert all(torch.equal(first[name], again[name]) for name in first)
    other = build_learner(config, seed=6).state_dict()
    assert not torch.equal(first["alpha.weight"], other["alpha.weight"])
