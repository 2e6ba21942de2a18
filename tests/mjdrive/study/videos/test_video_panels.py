import numpy as np
import pytest

from mjdrive.bev.picture import CAR
from mjdrive.datatypes import Town
from mjdrive.study.videos.video_panels import PANEL, WHITE, landscape_panel, map_panel
from mjdrive.vehicle.parameters import VehicleParameters

EVEN = np.full((9, 9), 1 / 81)


def middle_of(image: np.ndarray, colour: tuple[int, int, int]) -> tuple[float, float]:
    rows, columns = np.nonzero((image == colour).all(axis=2))
    return float(rows.mean()), float(columns.mean())


@pytest.mark.parametrize(("acceleration", "steering"), [(0.5, 0.5), (0.5, -0.5), (-0.5, 0.5)])
def test_left_is_left_and_throttle_is_up(acceleration: float, steering: float) -> None:
    row, column = middle_of(landscape_panel(EVEN, np.array([acceleration, steering])), WHITE)
    assert (row < PANEL / 2) == (acceleration > 0)
    assert (column < PANEL / 2) == (steering > 0)


def test_the_chosen_action_lies_where_the_landscape_is_dark() -> None:
    peaked = np.full((33, 33), 1e-12)
    peaked[8, 28] = 1.0  # some brake, well to the left
    action = np.linspace(-1, 1, 33)[[8, 28]]
    panel = landscape_panel(peaked, action)
    row, column = middle_of(panel, WHITE)
    ring = panel[int(row) - 16 : int(row) + 17, int(column) - 16 : int(column) + 17]
    assert ring.sum(axis=2).min() < panel[PANEL // 4, 3 * PANEL // 4].sum() / 2


def test_an_action_on_the_edge_is_seen_whole() -> None:
    inside = (landscape_panel(EVEN, np.array([0.5, 0.5])) == WHITE).all(axis=2).sum()
    edge = (landscape_panel(EVEN, np.array([1.0, -1.0])) == WHITE).all(axis=2).sum()
    assert edge == pytest.approx(inside, rel=0.1)


def test_the_car_is_drawn_where_it_is(town02: Town) -> None:
    middle = np.array([100.0, -200.0])
    path = np.zeros((1, 6))
    path[0, :2] = middle + np.array([10.0, 0.0])  # east of the middle
    panel = map_panel(town02, middle, path, VehicleParameters.default(), clock=0.0)
    row, column = middle_of(panel, CAR)
    assert column > PANEL / 2 + 40
    assert row == pytest.approx(PANEL / 2, abs=2.0)
