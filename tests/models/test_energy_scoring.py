import pytest
import torch

from models import hardware
from models.energy import EnergyHead
from models.energy_scoring import ROWS_AT_A_TIME, EnergyScorer, resolved
from models.samplers.grid import action_grid


@pytest.fixture
def head():
    """A head whose energies span 14 nats on the box of actions: probabilities in a ratio of a million."""
    torch.manual_seed(0)
    head = EnergyHead(16, action_gain=16.0)
    with torch.no_grad():
        head.last.weight *= 10
    return head


@pytest.fixture
def features():
    return torch.randn(3, 16, generator=torch.Generator().manual_seed(1))


def plain(head, features, actions):
    """The network on joined vectors, in double precision."""
    double = head.double()
    actions = actions.expand(len(features), -1, -1)
    joined = torch.cat((features[:, None].expand(-1, actions.shape[1], -1), actions), dim=2)
    hidden = torch.relu(double.first(joined.double()))
    energies = double.last(torch.relu(double.second(hidden))).squeeze(-1).detach()
    head.float()
    return energies


@pytest.mark.parametrize("num_candidates", [1, 7, ROWS_AT_A_TIME + 1])
def test_float32_scores_are_those_of_the_network(head, features, num_candidates):
    actions = 2 * torch.rand(3, num_candidates, 2) - 1
    scores = EnergyScorer(head, features, "float32")(actions)
    expected = plain(head, features, actions).float()
    torch.testing.assert_close(scores, expected, rtol=1e-5, atol=1e-4)


@pytest.mark.parametrize(("precision", "tolerance"), [("float32", 1e-4), ("bfloat16", 0.01)])
def test_probabilities_on_a_grid_are_those_of_a_plain_softmax(head, features, precision, tolerance):
    """Total variation; docs/notes.md has that of trained networks in bfloat16."""
    grid = action_grid(65)[None]
    expected = plain(head, features, grid)
    assert (expected.amax(1) - expected.amin(1) > 10).all()
    scores = EnergyScorer(head, features, precision)(grid)
    difference = torch.softmax(-scores.double(), 1) - torch.softmax(-expected, 1)
    assert (0.5 * difference.abs().sum(1) < tolerance).all()


def test_bfloat16_tells_candidates_apart_that_bfloat16_itself_does_not(head, features):
    """Around 0.75 its neighbours are 0.004 apart."""
    steps = torch.linspace(0.75, 0.7535, 8)
    actions = torch.stack((steps, steps), dim=1)[None]
    assert len(actions.bfloat16().unique()) == 2
    scores = EnergyScorer(head, features, "bfloat16")(actions)
    assert all(len(row.unique()) == 8 for row in scores)


@pytest.mark.parametrize("precision", ["float32", "bfloat16"])
def test_shared_candidates_equal_repeated_ones(head, features, precision):
    scorer = EnergyScorer(head, features, precision)
    actions = torch.rand(1, 9, 2)
    assert torch.equal(scorer(actions), scorer(actions.repeat(3, 1, 1)))


@pytest.mark.parametrize("precision", ["float32", "bfloat16"])
def test_scores_need_no_gradients_and_have_none(head, features, precision):
    assert torch.is_grad_enabled()
    assert not EnergyScorer(head, features, precision)(torch.rand(1, 9, 2)).requires_grad


@pytest.mark.parametrize("precision", ["float32", "bfloat16"])
def test_scores_do_not_depend_on_the_number_of_threads(head, features, precision):
    actions = 2 * torch.rand(1, 5000, 2, generator=torch.Generator().manual_seed(2)) - 1
    before, scores = torch.get_num_threads(), []
    try:
        for num_threads in (1, 2, 3):
            torch.set_num_threads(num_threads)
            scores.append(EnergyScorer(head, features, precision)(actions))
    finally:
        torch.set_num_threads(before)
    assert torch.equal(scores[0], scores[1])
    assert torch.equal(scores[0], scores[2])


@pytest.mark.parametrize(("is_fast", "expected"), [(True, "bfloat16"), (False, "float32")])
def test_auto_takes_bfloat16_only_where_it_is_fast(head, features, is_fast, expected, monkeypatch):
    monkeypatch.setattr(hardware, "bfloat16_is_fast", lambda device: is_fast)
    assert resolved("auto") == expected
    assert EnergyScorer(head, features).precision == expected
    assert EnergyScorer(head, features, "float32").precision == "float32"
    assert EnergyScorer(head, features, "bfloat16").precision == "bfloat16"
