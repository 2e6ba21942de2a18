"""The sampler and the density of flow matching, with a network that knows the exact answer."""

import dataclasses

import pytest
import torch

from models.flow import FlowLearner


class Oracle(torch.nn.Module):
    """Predicts the velocity of a flow that has learnt a fork without any error."""

    def __init__(self, fork):
        super().__init__()
        self.fork = fork

    def observe(self, features):
        return features[:, None]

    def forward(self, observed, noisy, time):
        clean = self.fork.clean(noisy, time, 1 - time)
        return (clean - noisy) / (1 - time)


class Featureless(torch.nn.Module):
    """Stands in for the encoder."""

    def forward(self, bev, state):
        return torch.zeros(len(bev), 1)


@pytest.fixture
def build(small_config, fork):
    def build(**flow):
        config = small_config("flow")
        learner = FlowLearner(
            dataclasses.replace(config, flow=dataclasses.replace(config.flow, **flow))
        )
        learner.encoder = Featureless()
        learner.denoiser = Oracle(fork)
        return learner

    return build


@pytest.mark.parametrize(("integrator", "steps"), [("euler", 64), ("midpoint", 16)])
def test_samples_have_masses_centres_and_spread_of_the_modes(
    integrator, steps, build, fork, generator
):
    learner = build(integrator=integrator, steps=steps)
    actions = learner.act(*fork.unseen(2500), generator=generator)
    is_left = actions[:, 1] > 0
    assert float(is_left.float().mean()) == pytest.approx(fork.share_left, abs=0.03)
    left = actions[is_left]
    torch.testing.assert_close(left.mean(dim=0), fork.centres[0], rtol=0, atol=0.01)
    torch.testing.assert_close(left.std(dim=0), torch.full((2,), fork.deviation), rtol=0.15, atol=0)


def test_the_steps_of_the_preset_keep_the_masses(build, fork, generator):
    actions = build().act(*fork.unseen(4000), generator=generator)
    share = float((actions[:, 1] > 0).float().mean())
    assert share == pytest.approx(fork.share_left, abs=0.05)


@pytest.mark.parametrize(("integrator", "order"), [("euler", 1), ("midpoint", 2)])
def test_the_error_falls_with_the_power_of_the_step_that_the_integrator_promises(
    integrator, order, build, generator
):
    noise = torch.randn(1, 20, 2, generator=generator).double()

    def actions(**flow):
        learner = build(**flow)
        # Smooth in time, as the order is that of small steps.
        learner.denoiser.forward = lambda observed, noisy, time: (1 + time) * torch.sin(noisy)
        return learner.generate(torch.zeros(1, 1, 1), noise, generator=generator)

    exact = actions(integrator="midpoint", steps=1000)
    coarse, fine = (
        float((actions(integrator=integrator, steps=steps) - exact).norm()) for steps in (10, 20)
    )
    assert coarse / fine == pytest.approx(2**order, rel=0.1)


def test_the_target_is_the_rate_of_the_mixture(build):
    actions, noise = torch.rand(3, 1, 2).double(), torch.randn(3, 4, 2).double()
    times = torch.rand(3, 4, 1).double()
    learner, step = build(), 1e-6
    ahead, behind = (learner.mix(actions, noise, times + sign * step)[0] for sign in (1, -1))
    torch.testing.assert_close(learner.mix(actions, noise, times)[1], (ahead - behind) / (2 * step))


def test_an_expert_that_always_does_the_same_is_met_by_one_step(
    build, fork, generator, monkeypatch
):
    monkeypatch.setattr(fork.__class__, "deviation", 1e-9)
    monkeypatch.setattr(fork.__class__, "share_left", 1 - 1e-9)
    actions = build(integrator="euler", steps=1).act(*fork.unseen(20), generator=generator)
    torch.testing.assert_close(actions, fork.centres[:1].expand(20, -1))
