"""The exact likelihood on the grid, against closed forms."""

import math

import numpy as np
import pytest

from mjdrive.study.jobs.held_out import gain

POINTS = 128


def axes() -> tuple[np.ndarray, np.ndarray]:
    axis = np.linspace(-1, 1, POINTS)
    return np.meshgrid(axis, axis, indexing="ij")


def test_who_finds_all_actions_alike_gains_nothing() -> None:
    assert gain(np.full((POINTS, POINTS), 3.7), np.array([0.2, -0.9])) == pytest.approx(0.0)


def test_who_is_sure_gains_the_logarithm_of_the_number_of_cells() -> None:
    told = np.full((POINTS, POINTS), -1000.0)
    told[-1, 0] = 0.0
    assert gain(told, np.array([1.0, -1.0])) == pytest.approx(math.log(POINTS**2))
    assert gain(told, np.array([-1.0, 1.0])) == pytest.approx(math.log(POINTS**2) - 1000.0)


def test_a_gaussian_gains_what_its_density_says() -> None:
    acceleration, steering = axes()
    sigma = 0.1
    told = -0.5 * ((acceleration - 0.2) ** 2 + (steering + 0.1) ** 2) / sigma**2
    label = np.array([acceleration[80, 0], steering[0, 60]])
    density = -0.5 * ((label[0] - 0.2) ** 2 + (label[1] + 0.1) ** 2) / sigma**2
    density -= math.log(2 * math.pi * sigma**2)
    cell = (2 / (POINTS - 1)) ** 2
    expected = density + math.log(cell) + math.log(POINTS**2)
    assert gain(told, label) == pytest.approx(expected, abs=1e-6)


def test_a_constant_does_not_count_and_neither_does_the_place_within_a_cell() -> None:
    told = np.random.default_rng(0).normal(size=(POINTS, POINTS))
    label = np.array([0.3, 0.4])
    assert gain(told + 50, label) == pytest.approx(gain(told, label))
    assert gain(told, label + 0.001) == gain(told, label)
