import pytest
import torch

from models.config import GridConfig
from models.samplers import grid
from models.samplers.commitment import NUM_SIDES, draw_committed, draw_sides, modes

POINTS = 33


def log_weights(*peaks: tuple[float, float, float]) -> torch.Tensor:
    """Peaks of some mass at some acceleration and steering on a grid, one row."""
    actions = grid.action_grid(POINTS)
    density = sum(
        mass * torch.exp(-0.5 * ((actions - torch.tensor(centre)) / 0.1).square().sum(dim=1))
        for mass, *centre in peaks
    )
    return torch.log(density + 1e-12)[None]


FORK = log_weights((0.65, 0.3, 0.5), (0.35, 0.3, -0.5))


def drawn_steering(rows, sides, generator) -> torch.Tensor:
    indices = draw_committed(rows, sides, split=0.15, generator=generator)
    return grid.action_grid(POINTS)[indices.squeeze(1), 1]


def test_what_is_drawn_at_one_moment_is_as_without_commitment(generator):
    rows = FORK.expand(4000, -1)
    steering = drawn_steering(rows, draw_sides(4000, generator=generator), generator)
    assert (steering > 0).float().mean().item() == pytest.approx(0.65, abs=0.03)
    shares = torch.softmax(FORK, dim=1)[0]
    spread = (shares * (grid.action_grid(POINTS)[:, 1] - (2 * 0.65 - 1) * 0.5).square()).sum()
    assert steering.var().item() == pytest.approx(spread.item(), rel=0.05)


def test_a_side_is_kept_as_long_as_its_noise_lasts_and_all_else_is_drawn_anew(generator):
    for _ in range(5):
        sides = draw_sides(1, generator=generator)
        steering = torch.cat([drawn_steering(FORK, sides, generator) for _ in range(50)])
        assert len(set((steering > 0).tolist())) == 1
        assert len(set(steering.tolist())) > 3


def test_a_side_is_left_when_it_is_no_way_any_more(generator):
    sides = torch.tensor([[-5.0, 0.0, 5.0]])  # fond of the left
    assert (drawn_steering(FORK, sides, generator) > 0).all()
    only_right = log_weights((1.0, 0.3, -0.5))
    assert (drawn_steering(only_right, sides, generator) < 0).all()


def test_one_mode_is_drawn_from_as_if_nothing_lasted(generator):
    """Around straight on, where actions lie on both sides of the split."""
    rows = log_weights((1.0, 0.0, 0.1)).expand(4000, -1)
    sides = draw_sides(1, generator=generator).expand(4000, -1)
    steering = drawn_steering(rows, sides, generator)
    assert steering.mean().item() == pytest.approx(0.1, abs=0.01)
    assert steering.std().item() == pytest.approx(0.1, rel=0.1)


def test_every_point_belongs_to_the_top_that_one_climbs_to_from_it():
    tops, actions = modes(FORK)[0], grid.action_grid(POINTS)
    assert torch.equal(tops[tops], tops), "a top is its own"
    for centre in (0.5, -0.5):
        near = (actions - torch.tensor([0.3, centre])).norm(dim=1) < 0.4
        (top,) = tops[near].unique()
        assert actions[top].tolist() == pytest.approx([0.3, centre], abs=1 / POINTS)


def test_the_grid_sampler_keeps_sides(generator):
    def energy(actions):
        del actions
        return -FORK

    config = GridConfig(points=POINTS)
    for side in (-1.0, 1.0):
        sides = torch.tensor([[-9.0 * side, -20.0, 9.0 * side]])
        chosen = grid.choose(energy, config, generator=generator, sides=sides)
        assert (chosen[:, 1] * side > 0).all()


def test_noise_is_standard_gumbel(generator):
    noise = draw_sides(20_000, generator=generator)
    assert noise.shape == (20_000, NUM_SIDES)
    assert noise.mean().item() == pytest.approx(0.5772, abs=0.02)
    assert noise.var().item() == pytest.approx(torch.pi**2 / 6, rel=0.03)
