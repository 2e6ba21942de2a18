"""The sampler and the density of diffusion, with a network that knows the exact answer."""

import dataclasses
import math

import pytest
import torch

from models.diffusion import DiffusionLearner

SHARE_OF_DRAWS = 0.03


class Oracle(torch.nn.Module):
    """Predicts what a network that has learnt a fork without any error does."""

    def __init__(self, fork, prediction):
        super().__init__()
        self.fork = fork
        self.predicts_noise = prediction == "epsilon"

    def observe(self, features):
        return features[:, None]

    def forward(self, observed, noisy, time):
        cos, sin = math.cos(math.pi / 2 * time), math.sin(math.pi / 2 * time)
        clean = self.fork.clean(noisy, cos, sin)
        noise = (noisy - cos * clean) / sin
        return noise if self.predicts_noise else cos * noise - sin * clean

    def with_divergence(self, observed, noisy, time):
        with torch.inference_mode(mode=False), torch.enable_grad():
            noisy = noisy.clone().requires_grad_()
            predicted = self(observed, noisy, time)
            slopes = [
                torch.autograd.grad(predicted[:, axis].sum(), noisy, retain_graph=True)[0]
                for axis in range(2)
            ]
        return predicted.detach(), slopes[0][:, 0] + slopes[1][:, 1]


class Featureless(torch.nn.Module):
    """Stands in for the encoder."""

    def forward(self, bev, state):
        return torch.zeros(len(bev), 1)


@pytest.fixture
def build(small_config, fork):
    def build(**diffusion):
        config = small_config("diffusion")
        changed = dataclasses.replace(config.diffusion, **diffusion)
        learner = DiffusionLearner(dataclasses.replace(config, diffusion=changed))
        learner.encoder = Featureless()
        learner.denoiser = Oracle(fork, changed.prediction)
        return learner

    return build


@pytest.mark.parametrize("prediction", ["v", "epsilon"])
@pytest.mark.parametrize("sampler", ["ddim", "ddpm"])
def test_samples_have_masses_centres_and_spread_of_the_modes(
    prediction, sampler, build, fork, generator
):
    learner = build(prediction=prediction, sampler=sampler, steps=150, clip=False)
    actions = learner.act(*fork.unseen(2500), generator=generator)
    is_left = actions[:, 1] > 0
    assert float(is_left.float().mean()) == pytest.approx(fork.share_left, abs=SHARE_OF_DRAWS)
    left = actions[is_left]
    torch.testing.assert_close(left.mean(dim=0), fork.centres[0], rtol=0, atol=0.01)
    torch.testing.assert_close(left.std(dim=0), torch.full((2,), fork.deviation), rtol=0.15, atol=0)


@pytest.mark.parametrize("sampler", ["ddim", "ddpm"])
def test_few_steps_keep_the_masses(sampler, build, fork, generator):
    learner = build(sampler=sampler, steps=8)
    actions = learner.act(*fork.unseen(4000), generator=generator)
    share = float((actions[:, 1] > 0).float().mean())
    assert share == pytest.approx(fork.share_left, abs=0.05)


def test_ddim_turns_the_same_noise_into_the_same_action_and_ddpm_does_not(build, fork, generator):
    noise = torch.randn(1, 50, 2, generator=generator)
    found = {
        sampler: [
            build(sampler=sampler).generate(torch.zeros(1, 1, 1), noise, generator=generator)
            for _ in range(2)
        ]
        for sampler in ("ddim", "ddpm")
    }
    assert torch.equal(*found["ddim"])
    assert not torch.equal(*found["ddpm"])


def test_clipping_keeps_what_a_wild_network_says_within_bounds(build, generator):
    noise = torch.randn(1, 50, 2, generator=generator)
    reach = {}
    for clip in (True, False):
        learner = build(clip=clip)
        learner.denoiser.forward = lambda observed, noisy, time: -5 * noisy
        actions = learner.generate(torch.zeros(1, 1, 1), noise, generator=generator)
        reach[clip] = float(actions.abs().max())
    assert reach[True] <= 1
    assert reach[False] > 1


@pytest.mark.parametrize("prediction", ["v", "epsilon"])
def test_the_density_is_that_of_the_demonstrations_with_the_noise_floor(prediction, build, fork):
    learner = build(prediction=prediction)
    axis = torch.linspace(-1, 1, 25)
    points = torch.cartesian_prod(axis, axis)
    told = learner.log_density(*fork.unseen(1), points[None])[0]
    known = fork.log_density(points, noise=learner.config.denoiser.noise_floor)
    likely = known > -3
    # The noise of the last time is a little narrower and not quite round: the mean of the actions is still in it.
    tolerance = 0.05 if prediction == "v" else 0.2
    torch.testing.assert_close(told[likely], known[likely], rtol=0, atol=tolerance)


def test_the_target_of_v_is_the_rate_at_which_the_mixture_turns(build):
    actions, noise = torch.rand(3, 1, 2), torch.randn(3, 4, 2)
    times = torch.rand(3, 4, 1).double()
    learner, step = build(prediction="v"), 1e-6
    ahead, behind = (
        learner.mix(actions.double(), noise.double(), times + sign * step)[0] for sign in (1, -1)
    )
    rate = (ahead - behind) / (2 * step * math.pi / 2)
    torch.testing.assert_close(learner.mix(actions.double(), noise.double(), times)[1], rate)
