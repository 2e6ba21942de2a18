"""Traffic signs: posts that the car can hit, and boards that say what the map says."""

from collections.abc import Sequence

import mujoco
import numpy as np

from mjdrive.datatypes import Sign
from mjdrive.simulation.blocks import add_post
from mjdrive.simulation.meshes import Shell
from mjdrive.town.opendrive.vocabulary import SPEED_LIMIT_TYPE

POST_RADIUS = 0.035  # [m]
POST_HEIGHT = 2.9  # [m]
BOARD_HEIGHT = 2.55  # middle of the board [m]
BOARD_RADIUS = 0.34  # [m]
RIM_SHARE = 0.78  # of the radius that is white inside the red rim [-]
SIDES = 18  # of a round board
LAYER = 0.012  # between board, face and digits [m]
DIGIT = (0.15, 0.30, 0.045)  # width, height and stroke [m]
DIGIT_PITCH = 0.20  # [m]
WIDEST_NUMBER = 2.3  # in digits of full size; longer ones are drawn smaller [-]

# Which strokes of a seven-segment digit are drawn: top, upper left and right, middle, lower left and right, bottom.
SEGMENTS = (0b1110111, 0b0010010, 0b1011101, 0b1011011, 0b0111010, 0b1101011, 0b1101111, 0b1010010, 0b1111111, 0b1111011)  # fmt: skip


def add_signs(spec: mujoco.MjSpec, signs: Sequence[Sign]) -> None:
    """Stand signs: speed limits as round boards with their number, all others as blank boards.

    Args:
        spec: Scene with the materials of `palette`.
        signs: Where they stand and what they say.
    """
    shells = {name: Shell() for name in ("zinc", "sign_red", "sign_white", "sign_black")}
    for sign in signs:
        name = f"sign_{sign.id}"
        add_post(
            spec,
            name,
            x=sign.x,
            y=sign.y,
            radius=POST_RADIUS,
            height=POST_HEIGHT,
            material="zinc",
        )
        is_limit = sign.type == SPEED_LIMIT_TYPE and sign.value >= 0
        front = POST_RADIUS + LAYER
        _disc(shells["zinc"], sign, BOARD_RADIUS, front, back=True)
        _disc(shells["sign_red" if is_limit else "sign_white"], sign, BOARD_RADIUS, front)
        if is_limit:
            _disc(shells["sign_white"], sign, RIM_SHARE * BOARD_RADIUS, front + LAYER)
            _number(shells["sign_black"], sign, round(sign.value), front + 2 * LAYER)
    for material, shell in shells.items():
        shell.show(spec, f"boards_{material}", material=material)


def _disc(shell: Shell, sign: Sign, radius: float, front: float, *, back: bool = False) -> None:
    angle = np.arange(SIDES) * 2.0 * np.pi / SIDES
    corners = _on_board(sign, radius * np.stack([np.cos(angle), np.sin(angle)], axis=1), front)
    shell.polygon(corners[::-1] if back else corners)


def _number(shell: Shell, sign: Sign, number: int, front: float) -> None:
    digits = [int(digit) for digit in str(number)]
    scale = min(1.0, WIDEST_NUMBER / len(digits))
    for place, digit in enumerate(digits):
        middle = np.array([(place - 0.5 * (len(digits) - 1)) * DIGIT_PITCH, 0.0])
        for stroke, (centre, half) in enumerate(_strokes()):
            if SEGMENTS[digit] >> (6 - stroke) & 1:
                corners = half * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
                shell.polygon(_on_board(sign, scale * (middle + centre + corners), front))


def _strokes() -> list[tuple[np.ndarray, np.ndarray]]:
    """Centre and half size of the seven strokes, on the board [m]."""
    width, height, stroke = DIGIT
    x, y = 0.5 * (width - stroke), 0.5 * (height - stroke)
    flat = np.array([0.5 * width, 0.5 * stroke])
    tall = np.array([0.5 * stroke, 0.25 * height + 0.25 * stroke])
    return [
        (np.array([0.0, y]), flat),
        (np.array([-x, 0.5 * y]), tall),
        (np.array([x, 0.5 * y]), tall),
        (np.array([0.0, 0.0]), flat),
        (np.array([-x, -0.5 * y]), tall),
        (np.array([x, -0.5 * y]), tall),
        (np.array([0.0, -y]), flat),
    ]


def _on_board(sign: Sign, points: np.ndarray, front: float) -> np.ndarray:
    """Bring points of the board, right and up as the driver sees it, into the world frame [m]."""
    forward = np.array([np.cos(sign.yaw), np.sin(sign.yaw)])
    right = np.array([forward[1], -forward[0]])
    ground = np.array([sign.x, sign.y]) - front * forward + points[:, :1] * right
    return np.column_stack([ground, BOARD_HEIGHT + points[:, 1]])
