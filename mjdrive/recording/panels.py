"""Pictures of a video frame: what is thought of a situation, and where the car is. Drawn without OpenGL."""

import math
from collections.abc import Iterable
from functools import lru_cache

import cv2
import matplotlib
import numpy as np
from jaxtyping import Float, UInt8
from matplotlib.colors import to_rgb

from mjdrive.bev.picture import CAR, GROUND, LIGHTS, ROAD, Rgb
from mjdrive.datatypes import Infraction, Town
from mjdrive.evaluation.figure_style import SYMBOLS
from mjdrive.evaluation.landscape import DEEPEST, energies
from mjdrive.geometry import world_from_vehicle
from mjdrive.town import signals
from mjdrive.town.surface import edges
from mjdrive.vehicle.parameters import VehicleParameters

PANEL = 384
"""Width and height of a panel [px]."""

FRAME = 12
"""Around a landscape, so that actions on its edge are seen whole [px]."""

REACH = 32.0
"""The map of a turn shows so much on each side of its middle [m]."""

MARGIN = 12.0
"""Ground that the map of a town shows around its lanes [m]."""

WHITE, INK, LINE, TRACE = (255, 255, 255), (31, 35, 40), (110, 119, 129), (9, 105, 218)

_SUBPIXELS = 4  # binary digits
_FINE = 2**_SUBPIXELS


def landscape_panel(
    probabilities: Float[np.ndarray, "A S"] | None, action: Float[np.ndarray, "2"]
) -> UInt8[np.ndarray, "P P 3"]:
    """Draw a landscape with the action that was chosen, steering from left to right, acceleration upwards.

    Args:
        probabilities: Of the points of an even grid of actions, acceleration outermost [-]; None if nothing is known of
            other actions, as of an expert.
        action: Acceleration and steering [-].
    """
    middle, inner = PANEL // 2, PANEL - 2 * FRAME
    image = np.full((PANEL, PANEL, 3), GROUND, np.uint8)
    if probabilities is not None:
        colours = np.rint(255 * _colours()).astype(np.uint8)
        height = np.rint(energies(probabilities) / DEEPEST * 255).astype(np.uint8)
        small = colours[height[::-1, ::-1]]  # upwards is first, left is positive
        image[FRAME:-FRAME, FRAME:-FRAME] = cv2.resize(
            small, (inner, inner), interpolation=cv2.INTER_CUBIC
        )
    cv2.line(image, (middle, FRAME), (middle, PANEL - FRAME), LINE, 1, cv2.LINE_AA)
    cv2.line(image, (FRAME, middle), (PANEL - FRAME, middle), LINE, 1, cv2.LINE_AA)
    place = _fine(middle - inner / 2 * action[::-1])
    cv2.circle(image, place, 9 * _FINE, INK, cv2.FILLED, cv2.LINE_AA, _SUBPIXELS)
    cv2.circle(image, place, 7 * _FINE, WHITE, cv2.FILLED, cv2.LINE_AA, _SUBPIXELS)
    return image


def map_panel(
    town: Town,
    middle: Float[np.ndarray, "2"],
    path: Float[np.ndarray, "T 6"],
    parameters: VehicleParameters,
    *,
    clock: float,
) -> UInt8[np.ndarray, "P P 3"]:
    """Draw a part of the town with its lights, the way so far and the car at the end of it.

    Args:
        town: Where.
        middle: Of the picture, world frame [m].
        path: State of the car so far, as in `Episode.vehicle`.
        parameters: Of the car.
        clock: Time on the clock of the lights [s].
    """
    image = _with_lights(town, middle, REACH, clock=clock, width=3)
    _line(image, _pixels(path[:, :2], middle, REACH), TRACE, 3)
    x, y, yaw = path[-1, :3].tolist()
    tail, half = -parameters.rear_overhang, parameters.width / 2
    nose = tail + parameters.length
    corners = np.array([(tail, half), (nose, half), (nose, -half), (tail, -half)])
    outline = _pixels(world_from_vehicle(corners, x=x, y=y, yaw=yaw), middle, REACH)
    cv2.fillPoly(image, [np.rint(outline * _FINE).astype(np.int32)], CAR, cv2.LINE_AA, _SUBPIXELS)
    return image


def town_panel(
    town: Town,
    path: Float[np.ndarray, "T 6"],
    infractions: Iterable[Infraction],
    *,
    clock: float,
) -> UInt8[np.ndarray, "P P 3"]:
    """Draw a whole town with its lights, the way so far, what was done wrong, and an arrow for the car.

    Args:
        town: Where.
        path: State of the car so far, as in `Episode.vehicle`.
        infractions: Those so far, drawn in the colours of the figures.
        clock: Time on the clock of the lights [s].
    """
    middle = (town.bounds[:2] + town.bounds[2:]) / 2
    reach = float((town.bounds[2:] - town.bounds[:2]).max()) / 2 + MARGIN
    image = _with_lights(town, middle, reach, clock=clock, width=2)
    _line(image, _pixels(path[:, :2], middle, reach), TRACE, 2)
    for it in infractions:
        place = _fine(_pixels(np.array([[it.x, it.y]]), middle, reach)[0])
        colour = np.rint(255 * np.array(to_rgb(SYMBOLS[it.kind][2]))).astype(int).tolist()
        cv2.circle(image, place, 6 * _FINE, WHITE, cv2.FILLED, cv2.LINE_AA, _SUBPIXELS)
        cv2.circle(image, place, 5 * _FINE, colour, cv2.FILLED, cv2.LINE_AA, _SUBPIXELS)
    yaw = path[-1, 2]
    ahead, left = np.array([np.cos(yaw), -np.sin(yaw)]), np.array([-np.sin(yaw), -np.cos(yaw)])
    tip = _pixels(path[-1:, :2], middle, reach)[0]
    arrow = [tip + 9 * ahead, tip - 6 * ahead + 6 * left, tip - 6 * ahead - 6 * left]
    fine = np.rint(np.array(arrow) * _FINE).astype(np.int32)
    cv2.fillPoly(image, [fine], INK, cv2.LINE_AA, _SUBPIXELS)
    return image


def _with_lights(
    town: Town, middle: Float[np.ndarray, "2"], reach: float, *, clock: float, width: int
) -> UInt8[np.ndarray, "P P 3"]:
    """The lanes around a place, with what the lights show as lines of some width [px]."""
    image = _ground(town, *middle.tolist(), reach).copy()
    for light in town.lights.values():
        colour = LIGHTS[signals.at(light, clock)]
        _line(image, _pixels(light.stop_line, middle, reach), colour, width)
    return image


@lru_cache(maxsize=4)
def _ground(town: Town, x: float, y: float, reach: float) -> UInt8[np.ndarray, "P P 3"]:
    """The lanes around a place."""
    image = np.full((PANEL, PANEL, 3), GROUND, np.uint8)
    middle = np.array([x, y])
    for lane in town.lanes.values():
        left, right = edges(lane)
        near = np.hypot(*(lane.centerline - middle).T).min() < 2 * reach
        if near:
            outline = _pixels(np.concatenate([left, right[::-1]]), middle, reach)
            fine = np.rint(outline * _FINE).astype(np.int32)
            cv2.fillPoly(image, [fine], ROAD, cv2.LINE_AA, _SUBPIXELS)
            cv2.polylines(image, [fine], True, ROAD, 1, cv2.LINE_AA, _SUBPIXELS)
    return image


@lru_cache(maxsize=1)
def _colours() -> Float[np.ndarray, "256 3"]:
    """Of energies, as in the figures."""
    return np.asarray(matplotlib.colormaps["YlGnBu_r"](np.arange(256))[:, :3])


def _pixels(
    points: Float[np.ndarray, "N 2"], middle: Float[np.ndarray, "2"], reach: float
) -> Float[np.ndarray, "N 2"]:
    """Column and row of places of the world frame [px]; north is up."""
    scale = PANEL / (2 * reach)
    return PANEL / 2 + (points - middle) * np.array([scale, -scale])


def _line(image: np.ndarray, points: np.ndarray, colour: Rgb, width: int) -> None:
    fine = np.rint(points * _FINE).astype(np.int32)
    cv2.polylines(image, [fine], False, colour, width, cv2.LINE_AA, _SUBPIXELS)


def _fine(point: Float[np.ndarray, "2"]) -> tuple[int, int]:
    column, row = point.tolist()
    return math.floor(column * _FINE), math.floor(row * _FINE)
