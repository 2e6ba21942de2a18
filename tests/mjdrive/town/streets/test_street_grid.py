import numpy as np
import pytest

from mjdrive.town.streets.street_grid import GridSize, StreetGrid, thin_out


def test_a_whole_grid_has_junctions_everywhere_but_at_its_corners() -> None:
    size = GridSize(columns=4, rows=3)
    assert len(StreetGrid(size).junctions) == size.num_junctions == 8


def test_chains_lead_through_corners_from_junction_to_junction() -> None:
    grid = StreetGrid(GridSize(columns=3, rows=3))
    chains = grid.chains()
    assert ((0, 1), (0, 0), (1, 0)) in chains
    assert len(chains) == 8  # four corners and four spokes
    assert all(grid.degree(node) == 2 for chain in chains for node in chain[1:-1])


def test_leaving_out_a_chain_costs_the_junctions_that_it_says() -> None:
    grid = StreetGrid(GridSize(columns=3, rows=3))
    chain = ((1, 0), (1, 1))
    assert grid.loss(chain) == 1
    assert grid.leave_out(chain)
    assert (1, 0) not in grid.junctions
    assert grid.degree((1, 1)) == 3


def test_a_town_does_not_fall_apart() -> None:
    grid = StreetGrid(GridSize(columns=4, rows=3))
    assert grid.leave_out(((1, 0), (2, 0)))
    assert grid.leave_out(((1, 1), (2, 1)))
    last = next(chain for chain in grid.chains() if {(1, 2), (2, 2)} <= set(chain))
    assert not grid.leave_out(last)
    assert last in grid.chains()


@pytest.mark.parametrize("seed", range(20))
def test_a_thinned_grid_has_the_junctions_asked_for_or_there_is_none(seed: int) -> None:
    rng = np.random.default_rng(seed)
    grid = thin_out(GridSize(columns=5, rows=4), num_junctions=11, rng=rng)
    assert grid is None or len(grid.junctions) == 11


def test_a_grid_with_too_few_junctions_is_none() -> None:
    rng = np.random.default_rng(0)
    assert thin_out(GridSize(columns=3, rows=3), num_junctions=6, rng=rng) is None
