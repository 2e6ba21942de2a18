"""The three pictures of a video frame: what is seen, what is thought of it, and where the car is. Drawn without OpenGL."""

import math
from functools import lru_cache

import cv2
import matplotlib
import numpy as np
from jaxtyping import Float, UInt8

from mjdrive.bev.picture import CAR, GROUND, LIGHTS, ROAD, Rgb
from mjdrive.datatypes import Town
from mjdrive.geometry import world_from_vehicle
from mjdrive.study.pictures.figures_landscape import DEEPEST, energies
from mjdrive.town import signals
from mjdrive.town.surface import edges
from mjdrive.vehicle.parameters import VehicleParameters

PANEL = 384
"""Width and height of a panel [px]."""

FRAME = 12
"""Around a landscape, so that actions on its edge are seen whole [px]."""

REACH = 32.0
"""The map shows so much on each side of its middle [m]."""

WHITE, INK, LINE, TRACE = (255, 255, 255), (31, 35, 40), (110, 119, 129), (9, 105, 218)

_SUBPIXELS = 4  # binary digits
_FINE = 2**_SUBPIXELS


def landscape_panel(
    probabilities: Float[np.ndarray, "A S"], action: Float[np.ndarray, "2"]
) -> UInt8[np.ndarray, "P P 3"]:
    """Draw a landscape with the action that was chosen, steering from left to right, acceleration upwards.

    Args:
        probabilities: Of the points of an even grid of actions, acceleration outermost [-].
        action: Acceleration and steering [-].
    """
    colours = np.rint(255 * _colours()).astype(np.uint8)
    height = np.rint(energies(probabilities) / DEEPEST * 255).astype(np.uint8)
    small = colours[height[::-1, ::-1]]  # upwards is first, left is positive
    middle, inner = PANEL // 2, PANEL - 2 * FRAME
    image = np.full((PANEL, PANEL, 3), GROUND, np.uint8)
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
    image = _ground(town, *middle.tolist()).copy()
    for light in town.lights.values():
        colour = LIGHTS[signals.at(light, clock)]
        _line(image, _pixels(light.stop_line, middle), colour, 3)
    _line(image, _pixels(path[:, :2], middle), TRACE, 3)
    x, y, yaw = path[-1, :3].tolist()
    tail, half = -parameters.rear_overhang, parameters.width / 2
    nose = tail + parameters.length
    corners = np.array([(tail, half), (nose, half), (nose, -half), (tail, -half)])
    outline = _pixels(world_from_vehicle(corners, x=x, y=y, yaw=yaw), middle)
    cv2.fillPoly(image, [np.rint(outline * _FINE).astype(np.int32)], CAR, cv2.LINE_AA, _SUBPIXELS)
    return image


@lru_cache(maxsize=4)
def _ground(town: Town, x: float, y: float) -> UInt8[np.ndarray, "P P 3"]:
    """The lanes around a place."""
    image = np.full((PANEL, PANEL, 3), GROUND, np.uint8)
    middle = np.array([x, y])
    for lane in town.lanes.values():
        left, right = edges(lane)
        near = np.hypot(*(lane.centerline - middle).T).min() < 2 * REACH
        if near:
            outline = _pixels(np.concatenate([left, right[::-1]]), middle)
            fine = np.rint(outline * _FINE).astype(np.int32)
            cv2.fillPoly(image, [fine], ROAD, cv2.LINE_AA, _SUBPIXELS)
            cv2.polylines(image, [fine], True, ROAD, 1, cv2.LINE_AA, _SUBPIXELS)
    return image


@lru_cache(maxsize=1)
def _colours() -> Float[np.ndarray, "256 3"]:
    """Of energies, as in the figures."""
    return np.asarray(matplotlib.colormaps["YlGnBu_r"](np.arange(256))[:, :3])


def _pixels(
    points: Float[np.ndarray, "N 2"], middle: Float[np.ndarray, "2"]
) -> Float[np.ndarray, "N 2"]:
    """Column and row of places of the world frame [px]; north is up."""
    scale = PANEL / (2 * REACH)
    return PANEL / 2 + (points - middle) * np.array([scale, -scale])


def _line(image: np.ndarray, points: np.ndarray, colour: Rgb, width: int) -> None:
    fine = np.rint(points * _FINE).astype(np.int32)
    cv2.polylines(image, [fine], False, colour, width, cv2.LINE_AA, _SUBPIXELS)


def _fine(point: Float[np.ndarray, "2"]) -> tuple[int, int]:
    column, row = point.tolist()
    return math.floor(column * _FINE), math.floor(row * _FINE)
