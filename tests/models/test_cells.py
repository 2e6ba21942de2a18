import pytest
import torch

from models.cells import cell_areas, nearest_points, spread_over_cells


def test_cells_fill_the_box_and_those_at_the_ends_are_half_as_wide():
    areas = cell_areas(5, device=torch.device("cpu")).view(5, 5)
    assert float(areas.sum()) == pytest.approx(4)
    assert areas[0, 0] * 4 == areas[0, 2] * 2 == areas[2, 2] == 0.25


@pytest.mark.parametrize("action", [-1.0, -0.3, 0.0, 1.0])
def test_an_action_is_spread_as_a_truncated_gaussian(action):
    target = spread_over_cells(torch.full((1, 2), action), points=65, deviation=0.1)[0, 0]
    axis = torch.linspace(-1, 1, 65)
    widths = torch.full((65,), 2 / 64)
    widths[[0, -1]] /= 2
    density = target / widths
    expected = torch.exp(-0.5 * ((axis - action) / 0.1) ** 2)
    torch.testing.assert_close(density / density.max(), expected / expected.max())
    assert float(target.sum()) == pytest.approx(1)


def test_without_a_deviation_an_action_goes_to_the_nearest_point():
    target = spread_over_cells(torch.tensor([[0.13, -1.0]]), points=5, deviation=0.0)[0]
    assert target.tolist() == [[0, 0, 1, 0, 0], [1, 0, 0, 0, 0]]
    assert nearest_points(torch.tensor([[0.26, 1.0]]), points=5).tolist() == [[3, 4]]


def test_a_small_deviation_is_none():
    actions = torch.tensor([[0.5, -0.25]])
    sharp = spread_over_cells(actions, points=9, deviation=1e-3)
    torch.testing.assert_close(sharp, spread_over_cells(actions, points=9, deviation=0.0))


def test_many_actions_of_many_observations_are_spread_each_by_itself(generator):
    actions = 2 * torch.rand((3, 7, 2), generator=generator) - 1
    together = spread_over_cells(actions, points=17, deviation=0.05)
    assert together.shape == (3, 7, 2, 17)
    alone = spread_over_cells(actions[1, 4], points=17, deviation=0.05)
    torch.testing.assert_close(together[1, 4], alone)
