import itertools
import math

import pytest
import torch

from models.config import CommitmentConfig, GridConfig
from models.errors import ModelsError
from models.samplers import grid
from models.samplers.commitment import Commitment, modes, sides

POINTS = 33
LASTING = CommitmentConfig(hold=10**9, release=1.0)
"""Noise that never fades, and nothing that is gone on with for its own sake."""


def log_weights(*peaks: tuple[float, float, float]) -> torch.Tensor:
    """Peaks of some mass at some acceleration and steering on a grid, one row."""
    actions = grid.action_grid(POINTS)
    density = sum(
        mass * torch.exp(-0.5 * ((actions - torch.tensor(centre)) / 0.1).square().sum(dim=1))
        for mass, *centre in peaks
    )
    return torch.log(density + 1e-12)[None]


FORK = log_weights((0.65, -0.3, 0.5), (0.35, 0.3, -0.5))
"""Who turns to the left brakes."""


def drawn(rows: torch.Tensor, commitment: Commitment) -> torch.Tensor:
    return grid.action_grid(POINTS)[commitment.draw(rows).squeeze(1)]


def test_the_first_draw_of_many_drivers_is_as_without_commitment(generator):
    num_drivers = 20_000
    commitment = Commitment(CommitmentConfig(hold=9), num_drivers, generator=generator)
    actions = drawn(FORK.expand(num_drivers, -1), commitment)
    shares = torch.softmax(FORK, dim=1)
    assert (actions[:, 1] > 0).float().mean().item() == pytest.approx(0.65, abs=0.02)
    points = grid.action_grid(POINTS)
    mean = shares @ points
    expected = (points - mean).T @ ((points - mean) * shares.T)
    torch.testing.assert_close(actions.mean(dim=0), mean[0], atol=0.02, rtol=0)
    torch.testing.assert_close(actions.T.cov(), expected, atol=0.01, rtol=0)


def test_steering_keeps_its_place_and_acceleration_is_drawn_anew(generator):
    for _ in range(6):
        commitment = Commitment(LASTING, 1, generator=generator)
        actions = torch.cat([drawn(FORK, commitment) for _ in range(50)])
        assert len(set(actions[:, 1].tolist())) == 1
        assert len(set(actions[:, 0].tolist())) > 3
        is_left = bool(actions[0, 1] > 0)
        assert (actions[:, 0].mean() < 0) == is_left, "acceleration goes with steering"


def test_a_mode_that_splits_is_followed_to_the_same_side(generator):
    """Half of all turn left, little by little: whoever begins to, must not begin anew at each moment."""
    num_drivers = 400
    commitment = Commitment(LASTING, num_drivers, generator=generator)
    steering = torch.stack(
        [
            drawn(
                log_weights((0.5, 0.0, 0.0), (0.5, 0.0, 0.05 * step)).expand(num_drivers, -1),
                commitment,
            )[:, 1]
            for step in range(11)
        ]
    )
    ends_left = steering[-1] > 0.25
    assert ends_left.float().mean().item() == pytest.approx(0.5, abs=0.08)
    for before, after in itertools.pairwise(steering[:, ends_left]):
        assert (after >= before - 1e-6).all()


def test_a_turn_that_was_begun_is_gone_on_with_while_it_has_its_share(generator):
    config = CommitmentConfig(hold=1, release=0.2)
    for main in (1.0, -1.0):
        commitment = Commitment(config, 1, generator=generator)
        only = log_weights((1.0, 0.0, 0.5 * main))
        less = log_weights((0.3, 0.0, 0.5 * main), (0.7, 0.0, -0.5 * main))
        gone = log_weights((0.1, 0.0, 0.5 * main), (0.9, 0.0, -0.5 * main))
        assert main * drawn(only, commitment)[0, 1] > 0
        assert all(main * drawn(less, commitment)[0, 1] > 0 for _ in range(50))
        assert any(main * drawn(gone, commitment)[0, 1] < 0 for _ in range(50))


def test_nobody_has_to_go_straight_on(generator):
    commitment = Commitment(CommitmentConfig(hold=1), 1, generator=generator)
    rows = log_weights((0.9, 0.0, 0.0), (0.1, 0.0, 0.5))
    assert any(drawn(rows, commitment)[0, 1] > 0.3 for _ in range(200))


def test_one_mode_across_the_split_is_drawn_from_as_a_whole(generator):
    """Around straight on, where actions lie on both sides of the split."""
    commitment = Commitment(CommitmentConfig(hold=5), 4000, generator=generator)
    steering = drawn(log_weights((1.0, 0.0, 0.1)).expand(4000, -1), commitment)[:, 1]
    assert steering.mean().item() == pytest.approx(0.1, abs=0.01)
    assert steering.std().item() == pytest.approx(0.1, rel=0.1)


def test_every_point_belongs_to_the_top_that_one_climbs_to_from_it():
    tops, actions = modes(FORK)[0], grid.action_grid(POINTS)
    assert torch.equal(tops[tops], tops), "a top is its own"
    for centre in ((-0.3, 0.5), (0.3, -0.5)):
        near = (actions - torch.tensor(centre)).norm(dim=1) < 0.4
        (top,) = tops[near].unique()
        assert actions[top].tolist() == pytest.approx(centre, abs=1 / POINTS)
        assert set(sides(FORK, split=0.15)[0][near].tolist()) == {2 if centre[1] > 0 else 0}


def test_the_grid_sampler_keeps_to_what_lasts(generator):
    def energy(actions):
        del actions
        return -FORK

    commitment = Commitment(LASTING, 1, generator=generator)
    chosen = [
        grid.choose(energy, GridConfig(points=POINTS), generator=generator, commitment=commitment)
        for _ in range(30)
    ]
    assert len({action[0, 1].item() for action in chosen}) == 1


def test_the_place_fades_as_the_settings_say(generator):
    """Ranks of steering within one mode are ranks of the noise."""
    commitment = Commitment(CommitmentConfig(hold=5), 5000, generator=generator)
    rows = log_weights((1.0, 0.0, 0.0)).expand(5000, -1)
    steering = torch.stack([drawn(rows, commitment)[:, 1] for _ in range(6)])
    alike = torch.corrcoef(steering)[0, 5].item()
    assert alike == pytest.approx(math.exp(-1), abs=0.06)


@pytest.mark.parametrize("values", [{"hold": -1}, {"split": 0.0}, {"split": 1.0}, {"release": 0.0}])
def test_settings_without_meaning_are_refused(values):
    with pytest.raises(ModelsError):
        CommitmentConfig(**values)
