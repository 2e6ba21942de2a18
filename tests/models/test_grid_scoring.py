import dataclasses
import math

import pytest
import torch

from models import grid_scoring
from models.energy import EnergyHead
from models.energy_scoring import EnergyScorer, resolved_for
from models.grid_scoring import GridScorer
from models.ibc import IbcLearner
from models.presets import quick
from models.samplers.grid import action_grid, choose

FEATURES = 16


def head_of(gain, seed=0):
    """A head whose energies span many nats."""
    torch.manual_seed(seed)
    head = EnergyHead(FEATURES, action_gain=gain)
    with torch.no_grad():
        head.last.weight *= 10
    return head


@pytest.fixture
def head():
    return head_of(16.0)


@pytest.fixture
def features():
    return torch.randn(3, FEATURES, generator=torch.Generator().manual_seed(1))


@pytest.fixture
def pointed(head, features):
    """All units of both layers reach their hinge at the same action, for the first observation."""
    action = torch.tensor([0.3, -0.2])
    with torch.no_grad():
        head.first.bias -= head.first(torch.cat((features[0], action)))
        head.second.bias.zero_()
    return head


def plain(head, features, points):
    """The network on joined vectors, in double precision."""
    double, grid = EnergyHead(FEATURES).double(), action_grid(points).double()
    double.load_state_dict(head.state_dict())
    rows = features.double()[:, None].expand(-1, len(grid), -1)
    joined = torch.cat((rows, grid.expand(len(features), -1, -1)), dim=2)
    hidden = torch.relu(double.second(torch.relu(double.first(joined))))
    return double.last(hidden).squeeze(-1).detach()


def tiled(head, features, points, **kwargs):
    return GridScorer(head, features, **kwargs)(action_grid(points)[None])


def assert_same(found, expected):
    torch.testing.assert_close(
        found, expected.float(), rtol=1e-5, atol=2e-5 * expected.std().item()
    )


@pytest.mark.parametrize("points", [2, 3, 5, 16, 33, 65, 128, 200])
def test_energies_of_a_grid_are_those_of_the_network(head, features, points):
    assert_same(tiled(head, features, points), plain(head, features, points))


@pytest.mark.parametrize("gain", [0.0, 1.0, 4.0, 64.0, 1000.0])
def test_energies_are_exact_however_steep_the_network_is(features, gain):
    head = head_of(gain)
    assert_same(tiled(head, features, 65), plain(head, features, 65))


@pytest.mark.parametrize("most", [0.0, grid_scoring.MOST_PRODUCTS, math.inf])
def test_energies_are_exact_where_all_units_change_sides_in_a_tile(
    pointed, features, most, monkeypatch
):
    monkeypatch.setattr(grid_scoring, "MOST_PRODUCTS", most)
    assert_same(tiled(pointed, features, 128), plain(pointed, features, 128))


def test_only_tiles_with_many_units_that_change_sides_are_cut(pointed, features, monkeypatch):
    cut, quarters = [], grid_scoring._quarters
    monkeypatch.setattr(
        grid_scoring, "_quarters", lambda tiles: cut.append(tiles) or quarters(tiles)
    )
    tiled(pointed, features[:1], 128)
    assert 1 <= sum(len(tiles) for tiles in cut if tiles.shape[1] == 16) <= 16
    cut.clear()
    tiled(head_of(1.0), features[:1], 128)
    assert cut == []


def test_few_units_are_computed_action_by_action(monkeypatch):
    numbers, energies = [], GridScorer._energies
    monkeypatch.setattr(
        GridScorer,
        "_energies",
        lambda self, *args: numbers.append(args[1:]) or energies(self, *args),
    )
    torch.manual_seed(0)
    tiled(EnergyHead(256, action_gain=16.0), torch.rand(1, 256), 128)
    assert numbers
    assert all(first * second < 256 * 256 / 10 for first, second in numbers)


@pytest.mark.parametrize("numbers", [1, 10**9])
def test_how_many_tiles_are_worked_on_at_once_changes_nothing_but_rounding(
    head, features, numbers, monkeypatch
):
    monkeypatch.setattr(grid_scoring, "NUMBERS_AT_A_TIME", numbers)
    monkeypatch.setattr(grid_scoring, "TILES_AT_A_TIME", numbers)
    assert_same(tiled(head, features, 65), plain(head, features, 65))


def test_probabilities_are_those_of_a_plain_softmax(head, features):
    expected = plain(head, features, 128)
    assert (expected.amax(1) - expected.amin(1) > 10).all()
    found = tiled(head, features, 128)
    difference = torch.softmax(-found.double(), 1) - torch.softmax(-expected, 1)
    assert (0.5 * difference.abs().sum(1) < 1e-4).all()


def test_a_flat_energy_is_the_same_everywhere(head, features):
    with torch.no_grad():
        head.first.weight.zero_()
        head.first.bias.zero_()
    energies = tiled(head, features, 65)
    assert torch.equal(energies, energies[:1, :1].expand_as(energies))


def test_the_bottom_of_a_known_energy_is_found(generator):
    """4 |acceleration - 0.25| + 4 |steering + 0.5|, of four units."""
    head = EnergyHead(FEATURES)
    with torch.no_grad():
        for parameter in head.parameters():
            parameter.zero_()
        head.first.weight[:4, -2:] = torch.tensor([[1.0, 0], [-1.0, 0], [0, 1.0], [0, -1.0]])
        head.first.bias[:4] = torch.tensor([-0.25, 0.25, 0.5, -0.5])
        head.second.weight[:4, :4] = torch.eye(4)
        head.last.weight[0, :4] = 4
    scorer = GridScorer(head, torch.zeros(1, FEATURES))
    energies = scorer(action_grid(65)[None])
    away = (action_grid(65) - torch.tensor([0.25, -0.5])).abs().sum(1)
    torch.testing.assert_close(energies, 4 * away[None], rtol=0, atol=1e-5)
    settings = dataclasses.replace(quick("ibc").sampler.grid, points=65, choice="argmin")
    assert choose(scorer, settings, generator=generator).tolist() == [[0.25, -0.5]]


@pytest.mark.parametrize("points", [65, 128])
def test_scores_do_not_depend_on_the_number_of_threads(head, features, points):
    scores = [tiled(head, features, points, num_threads=count) for count in (1, 2, 3, 5, 7)]
    assert all(torch.equal(scores[0], other) for other in scores[1:])


def test_an_observation_has_the_same_scores_alone_up_to_rounding(head, features):
    together = tiled(head, features, 65)
    alone = [tiled(head, row[None], 65) for row in features]
    # What comes of the features is one product, and those of one row round otherwise than those of several.
    atol = 2e-5 * together.std().item()
    torch.testing.assert_close(together, torch.cat(alone), rtol=1e-5, atol=atol)


def test_scores_need_no_gradients_and_have_none(head, features):
    assert torch.is_grad_enabled()
    assert not tiled(head, features, 9).requires_grad


def test_candidates_that_are_no_grid_are_refused(head, features):
    with pytest.raises(AssertionError, match="square grid"):
        GridScorer(head, features)(torch.rand(1, 10, 2))


@pytest.mark.parametrize(
    ("precision", "scorer", "tolerance"),
    [("auto", GridScorer, 1e-5), ("float32", GridScorer, 1e-5), ("bfloat16", EnergyScorer, 0.01)],
)
def test_a_learner_shows_the_energies_of_its_grid_in_every_number_format(
    precision, scorer, tolerance, batch, generator
):
    config = quick("ibc")
    sampler = dataclasses.replace(config.sampler, precision=precision)
    learner, seen = IbcLearner(dataclasses.replace(config, sampler=sampler)).eval(), []
    learner.on_energies = seen.append
    learner.act(batch.bev[:2], batch.state[:2], generator=generator)
    assert isinstance(learner._scorer(torch.zeros(1, 256), num_threads=1), scorer)
    grid = action_grid(sampler.grid.points)[None]
    expected = learner.energies(batch.bev[:2], batch.state[:2], grid)
    torch.testing.assert_close(seen[0], expected, rtol=0, atol=tolerance)


def test_auto_means_float32_for_a_grid_on_a_cpu_alone(monkeypatch):
    monkeypatch.setattr("models.hardware.bfloat16_is_fast", lambda device: True)
    grid = quick("ibc").sampler
    assert grid.kind == "grid"
    assert resolved_for(grid) == "float32"
    assert resolved_for(grid, "cuda") == "bfloat16"
    assert resolved_for(dataclasses.replace(grid, kind="dfo")) == "bfloat16"
    assert resolved_for(dataclasses.replace(grid, precision="bfloat16")) == "bfloat16"
