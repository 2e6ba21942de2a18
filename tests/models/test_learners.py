"""What every learner keeps, whatever its method."""

import dataclasses

import pytest
import torch

from models import checkpoint, presets
from models.config import METHODS, CommitmentConfig, LearnerConfig, density_settings
from models.interfaces import Batch, Learner
from models.learners import build_learner


@pytest.fixture(scope="module", params=METHODS)
def learner(request, small_config, batch) -> Learner:
    learner = build_learner(small_config(request.param), seed=1)
    learner.prepare(batch.actions, torch.ones(len(batch.actions)))
    return learner


def act(learner, batch, seed):
    return learner.act(batch.bev, batch.state, generator=torch.Generator().manual_seed(seed))


def test_it_acts_within_bounds_and_as_its_generator_says(learner, batch):
    first, again = (act(learner, batch, seed=5) for _ in range(2))
    assert first.shape == (len(batch.actions), 2)
    assert first.dtype == torch.float32
    assert torch.all(first.abs() <= 1)
    assert torch.equal(first, again)


def test_it_draws_from_the_generator_alone(learner, batch):
    chances = []
    for seed in (3, 3, 4):
        torch.manual_seed(len(chances))
        chances.append(learner.draw(batch.actions, generator=torch.Generator().manual_seed(seed)))
    one, same, other = ([x for x in chance if x is not None] for chance in chances)
    assert all(torch.equal(a, b) for a, b in zip(one, same, strict=True))
    drawn = [x for x in one if len(x) > 0]
    assert not drawn or not all(torch.equal(a, b) for a, b in zip(one, other, strict=True))


def test_the_loss_of_parts_sums_to_that_of_the_whole(learner, batch, generator):
    chance = learner.draw(batch.actions, generator=generator)
    weights = torch.linspace(0.5, 1.5, len(batch.actions))
    whole = learner.loss(batch, chance, weights=weights)
    rows = slice(0, 3), slice(3, 10)
    parts = [
        learner.loss(Batch(*(x[part] for x in batch)), chance.part(part), weights=weights[part])
        * (part.stop - part.start)
        / 10
        for part in rows
    ]
    torch.testing.assert_close(sum(parts), whole, rtol=1e-5, atol=1e-6)
    assert torch.equal(whole, learner.loss(batch, chance, weights=weights))


def test_the_loss_stays_in_single_precision_when_products_do_not(learner, batch, generator):
    chance = learner.draw(batch.actions, generator=generator)
    with torch.autocast("cpu", torch.bfloat16):
        loss = learner.loss(batch, chance, weights=None)
    assert loss.dtype == torch.float32
    assert loss.bfloat16().float() != loss


@pytest.mark.parametrize("label", [-1.0, 0.0, 1.0])
def test_loss_and_gradient_are_finite_at_the_ends(learner, batch, label, generator):
    few = Batch(batch.bev[:2], batch.state[:2], torch.full((2, 2), label))
    learner.zero_grad()
    loss = learner.loss(few, learner.draw(few.actions, generator=generator), weights=None)
    loss.backward()
    assert torch.isfinite(loss)
    gradients = [p.grad for p in learner.parameters() if p.requires_grad]
    assert all(torch.isfinite(it).all() for it in gradients if it is not None)
    assert any(it is not None and it.abs().sum() > 0 for it in gradients)


def test_a_loaded_one_acts_and_tells_densities_as_the_saved_one(learner, batch, tmp_path):
    method = learner.config.method
    checkpoint.save(tmp_path, learner, checkpoint.RunState(method, seed=1, epoch=1, epochs=1))
    loaded = checkpoint.load(tmp_path)
    assert torch.equal(act(learner, batch, 2), act(loaded, batch, 2))
    actions = batch.actions[None, :4]
    saved, read = (
        it.log_density(batch.bev[:2], batch.state[:2], actions) for it in (learner, loaded)
    )
    assert torch.equal(saved, read)


def test_its_density_is_finite_everywhere_and_alike_for_shared_and_own_actions(learner, batch):
    bev, state = batch.bev[:2], batch.state[:2]
    corners = torch.tensor([[-1.0, -1.0], [-1.0, 0.0], [0.0, 0.0], [1.0, 1.0]])
    with torch.inference_mode():
        shared = learner.log_density(bev, state, corners[None])
    own = learner.log_density(bev, state, torch.stack((corners, corners.flip(0))))
    assert shared.shape == (2, 4)
    assert torch.all(torch.isfinite(shared))
    torch.testing.assert_close(own[0], shared[0])
    torch.testing.assert_close(own[1].flip(0), shared[1])


def test_its_first_weights_come_from_the_seed(learner):
    first, same, other = (build_learner(learner.config, seed=seed) for seed in (1, 1, 2))
    pairs = list(zip(*(it.parameters() for it in (first, same, other)), strict=True))
    assert all(torch.equal(a, b) for a, b, _ in pairs)
    assert not any(torch.equal(a, c) for a, _, c in pairs if a.dim() > 1)


SIZES = {
    "bc-beta": 1_391_204,
    "bc-mixture": 1_396_601,
    "bc-grid": 2_476_001,
    "ibc": 1_390_945,
    "da-ibc": 1_390_945,
    "ibc-langevin": 1_390_945,
    "diffusion": 1_327_202,
    "flow": 1_327_202,
}
"""As docs/methods.md says."""


def test_its_size_is_that_of_the_documentation(learner):
    built = build_learner(presets.standard(learner.config.method), seed=0)
    assert sum(it.numel() for it in built.parameters()) == SIZES[learner.config.method]


def test_the_density_is_the_same_where_its_settings_are(learner, batch):
    """However actions are drawn from it."""
    mine = learner.config
    drawn = dataclasses.replace(
        mine,
        beta=dataclasses.replace(mine.beta, inference="mean"),
        categorical=dataclasses.replace(mine.categorical, choice="argmax", temperature=0.5),
        denoiser=dataclasses.replace(mine.denoiser, candidates=7),
        sampler=dataclasses.replace(
            mine.sampler,
            grid=dataclasses.replace(mine.sampler.grid, choice="argmin", temperature=3.0),
        ),
        commitment=CommitmentConfig(hold=5, split=0.3, release=0.5),
    )
    assert density_settings(drawn) == density_settings(mine)
    told = []
    actions = 2 * torch.rand((1, 9, 2), generator=torch.Generator().manual_seed(2)) - 1
    for config in (mine, drawn):
        learner.config = config
        told.append(learner.log_density(batch.bev[:2], batch.state[:2], actions))
    learner.config = mine
    assert torch.equal(*told)


def test_settings_that_change_a_density_are_told_apart():
    plain = LearnerConfig("flow")
    floor = dataclasses.replace(plain.denoiser, noise_floor=0.2)
    assert density_settings(dataclasses.replace(plain, denoiser=floor)) != density_settings(plain)
    energy = presets.standard("da-ibc")
    uncorrected = dataclasses.replace(energy.negatives, correction="none")
    energy = dataclasses.replace(energy, negatives=uncorrected)
    undone = dataclasses.replace(energy.sampler, undo="negatives")
    assert density_settings(dataclasses.replace(energy, sampler=undone)) != density_settings(energy)
