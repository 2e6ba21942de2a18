import pytest
import torch

from models.samplers.draws import draw_ascending, draw_categorical, pick

WAYS = pytest.mark.parametrize("draw", [draw_categorical, draw_ascending])


@WAYS
def test_draws_follow_the_probabilities_and_skip_zeros(draw, generator):
    weights = torch.tensor([[0.0, 1.0, 3.0, 0.0], [5.0, 0.0, 0.0, 5.0]])
    drawn = draw(weights, 20_000, generator=generator)
    shares = torch.stack([torch.bincount(row, minlength=4) for row in drawn]) / 20_000
    assert (shares[weights == 0] == 0).all()
    torch.testing.assert_close(shares, weights / weights.sum(1, keepdim=True), rtol=0, atol=0.02)


@WAYS
def test_counts_are_multinomial(draw, generator):
    """Chi-squared over the counts has mean 49 and variance 98; systematic resampling, too even, fails as well."""
    weights = torch.rand(1, 50, generator=generator) + 0.1
    expected = 1000 * weights[0].double() / weights[0].double().sum()
    statistics = []
    for _ in range(200):
        counts = torch.bincount(draw(weights, 1000, generator=generator)[0], minlength=50)
        statistics.append(((counts - expected).square() / expected).sum().item())
    found = torch.tensor(statistics)
    assert found.mean().item() == pytest.approx(49, abs=2.8)  # four standard errors
    assert found.var().item() == pytest.approx(98, rel=0.45)


def test_ascending_draws_ascend(generator):
    drawn = draw_ascending(torch.rand(3, 100, generator=generator), 500, generator=generator)
    assert drawn.shape == (3, 500)
    assert (drawn.diff(dim=1) >= 0).all()


@WAYS
def test_one_draw_may_be_any_index(draw, generator):
    drawn = [draw(torch.ones(1, 3), 1, generator=generator).item() for _ in range(60)]
    assert set(drawn) == {0, 1, 2}


def test_pick_takes_each_row_from_its_own_candidates():
    candidates = torch.arange(12.0).view(2, 3, 2)
    picked = pick(candidates, torch.tensor([[2, 2, 0, 1], [0, 1, 1, 2]]))
    assert picked[..., 0].tolist() == [[4, 4, 0, 2], [6, 8, 8, 10]]
    assert (picked[..., 1] - picked[..., 0] == 1).all()
