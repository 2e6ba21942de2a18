import numpy as np
import pytest

from mjdrive.evaluation.landscape import entropy_bits, modes

AXIS = np.linspace(-1.0, 1.0, 129)


def mixture(*bumps: tuple[float, float, float], width: float = 0.08) -> np.ndarray:
    """Gaussian bumps (share, acceleration, steering) on the grid."""
    density = sum(
        share * np.exp(-0.5 * ((AXIS[:, None] - a) ** 2 + (AXIS[None] - s) ** 2) / width**2)
        for share, a, s in bumps
    )
    return np.asarray(density / density.sum())


def test_two_modes_have_their_places_and_masses() -> None:
    first, second = modes(mixture((0.65, 0.25, 0.5), (0.35, 0.25, -0.5)))
    assert first == pytest.approx((0.25, 0.5, 0.65), abs=0.01)
    assert second == pytest.approx((0.25, -0.5, 0.35), abs=0.01)


def test_ripples_are_no_modes() -> None:
    found = modes(mixture((0.97, 0.0, 0.0), (0.03, 0.0, 0.8)))
    assert [mode.mass for mode in found] == [pytest.approx(0.97, abs=0.01)]
    everything = modes(mixture((0.97, 0.0, 0.0), (0.03, 0.0, 0.8)), least_mass=0.01)
    assert sum(mode.mass for mode in everything) == pytest.approx(1.0)


def test_a_mode_at_the_edge_counts() -> None:
    (mode,) = modes(mixture((1.0, -1.0, 0.0)))
    assert mode == pytest.approx((-1.0, 0.0, 1.0), abs=1e-6)


def test_bumps_that_melt_into_one_are_one_mode() -> None:
    assert len(modes(mixture((0.5, 0.0, 0.05), (0.5, 0.0, -0.05)))) == 1


@pytest.mark.parametrize("points", [64, 65, 128])
def test_one_bump_is_one_mode_on_any_grid_and_in_any_rounding(points: int) -> None:
    axis = np.linspace(-1.0, 1.0, points)
    energy = 0.5 * (axis[:, None] ** 2 + axis[None] ** 2) / 0.2**2
    for rounded in (
        energy,
        np.round(energy, 1),
    ):  # in a coarse number format whole patches are equally high
        density = np.exp(-rounded)
        (mode,) = modes(density / density.sum())
        assert mode == pytest.approx((0.0, 0.0, 1.0), abs=0.1)


def test_a_flat_landscape_is_one_way_to_act() -> None:
    (mode,) = modes(np.full((65, 65), 1 / 65**2))
    assert mode.mass == pytest.approx(1.0)


def test_entropy_at_its_ends() -> None:
    even = np.full((128, 128), 1 / 128**2)
    assert entropy_bits(even) == pytest.approx(14.0)
    sure = np.zeros((128, 128))
    sure[3, 5] = 1.0
    assert entropy_bits(sure) == 0.0


def test_two_equal_ways_cost_one_bit() -> None:
    one, two = mixture((1.0, 0.0, 0.5)), mixture((0.5, 0.0, 0.5), (0.5, 0.0, -0.5))
    assert entropy_bits(two) - entropy_bits(one) == pytest.approx(1.0, abs=1e-6)
