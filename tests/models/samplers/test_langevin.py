import dataclasses
import math

import pytest
import torch

from models.config import ChainConfig, LangevinConfig
from models.errors import SettingError
from models.samplers.langevin import draw_noise, search, step_sizes, walk

SPREAD = 0.1
EVEN = ChainConfig(
    iterations=400, step_init=0.001, step_final=0.001, noise="root", step_clip=math.inf
)
"""Steps of one size."""


def bowl_slopes(actions):
    """Of E = |y|^2 / (2 SPREAD^2)."""
    return actions / SPREAD**2


def modes(share, spreads=(0.08, 0.08)):
    """Energy and slopes of two modes at steering +-0.4, the left one with a share of the mass."""
    masses = share / spreads[0] ** 2, (1 - share) / spreads[1] ** 2

    def energy(actions):
        logs = [
            math.log(mass)
            - 0.5 * (actions - torch.tensor([0.0, place])).square().sum(dim=-1) / spread**2
            for mass, place, spread in zip(masses, (0.4, -0.4), spreads, strict=True)
        ]
        return -torch.logaddexp(*logs)

    def slopes(actions):
        with torch.enable_grad():
            actions = actions.clone().requires_grad_()
            return torch.autograd.grad(energy(actions).sum(), actions)[0]

    return energy, slopes


def uniform(num_observations, num_chains, generator):
    return 2 * torch.rand(num_observations, num_chains, 2, generator=generator) - 1


def ends(slopes, start, chain, generator):
    noise = draw_noise(*start.shape[:2], chain, generator=generator)
    return walk(slopes, start, noise, chain)


def left_share(config, share, generator, spreads=(0.08, 0.08)):
    start = uniform(800, config.num_chains, generator)
    chosen = search(*modes(share, spreads), start, config, generator=generator)
    return (chosen[:, 1] > 0).float().mean().item()


def test_steps_fall_as_the_polynomial_of_the_settings():
    sizes = step_sizes(ChainConfig(iterations=5, step_init=0.5, step_final=0.1, step_power=2.0))
    assert sizes == pytest.approx([0.1 + 0.4 * (1 - i / 4) ** 2 for i in range(5)])
    assert step_sizes(ChainConfig(iterations=1)) == [0.1]


@pytest.mark.parametrize("noise", ["root", "step"])
def test_chains_settle_in_a_bowl_to_the_variance_of_the_closed_form(noise, generator):
    """y' = (1 - h / 2 s^2) y + c xi is a Gaussian process of variance c^2 / (1 - (1 - h / 2 s^2)^2)."""
    chain = dataclasses.replace(EVEN, noise=noise)
    size = chain.step_init
    found = ends(bowl_slopes, uniform(1, 4000, generator), chain, generator).std(dim=(0, 1))
    kept = 1 - size / (2 * SPREAD**2)
    spread = {"root": size**0.5, "step": size}[noise] / math.sqrt(1 - kept**2)
    assert found.tolist() == pytest.approx([spread] * 2, rel=0.05)
    if noise == "root":
        assert spread == pytest.approx(SPREAD, rel=0.02)
    else:
        assert spread < 0.05 * SPREAD


def test_the_steps_of_published_code_end_at_the_bottom(generator):
    chosen = search(
        lambda actions: bowl_slopes(actions).square().sum(dim=-1),
        bowl_slopes,
        uniform(20, 16, generator),
        LangevinConfig(choice="argmin"),
        generator=generator,
    )
    assert chosen.abs().max() < 0.02


def test_argmin_takes_the_deeper_mode(generator):
    config = LangevinConfig(num_chains=32, chain=ChainConfig(iterations=40))
    assert left_share(config, 0.65, generator) > 0.99


def test_chains_stay_in_the_box(generator):
    chain = dataclasses.replace(EVEN, noise_scale=0.0)
    found = ends(lambda y: torch.full_like(y, -100), uniform(1, 9, generator), chain, generator)
    assert (found == 1).all()


@pytest.mark.parametrize("share", [0.65, 0.9])
def test_chains_do_not_mix_between_distant_modes_so_their_start_decides(share, generator):
    """Half of a uniform start falls into either mode, however much mass it has."""
    chain = dataclasses.replace(EVEN, step_clip=0.1)
    config = LangevinConfig(num_chains=1, choice="chain", chain=chain)
    assert left_share(config, share, generator) == pytest.approx(0.5, abs=0.06)


def test_drawing_an_end_by_its_energy_gives_modes_of_one_width_their_masses(generator):
    config = LangevinConfig(num_chains=64, choice="sample")
    assert left_share(config, 0.65, generator) == pytest.approx(0.65, abs=0.06)


def test_drawing_an_end_by_its_energy_slights_a_broad_mode(generator):
    """The ends lie at the bottoms, and a broad mode of the same mass is less deep; that more chains find it is not enough."""
    config = LangevinConfig(num_chains=64, choice="sample")
    assert left_share(config, 0.65, generator, spreads=(0.16, 0.08)) < 0.6


def test_no_step_is_longer_than_the_clip(generator):
    chain = ChainConfig(iterations=3, step_init=1.0, step_clip=0.05)
    start = torch.zeros(1, 200, 2)
    assert ends(bowl_slopes, start, chain, generator).abs().max() <= 0.15 + 1e-6


def test_each_observation_has_chains_of_its_own(generator):
    targets = torch.tensor([[-0.5, 0.2], [0.7, -0.7]])
    chain = ChainConfig(noise_scale=0.0)
    found = ends(lambda y: 100 * (y - targets[:, None]), uniform(2, 5, generator), chain, generator)
    torch.testing.assert_close(found, targets[:, None].expand_as(found), rtol=0, atol=0.01)


def test_steps_that_grow_are_refused():
    with pytest.raises(SettingError, match=r"step_final is 1.0; expected at most step_init, 0.1"):
        ChainConfig(step_final=1.0)
