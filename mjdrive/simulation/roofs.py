"""Roofs: gables on low houses, flat ones with a cornice on high ones."""

import mujoco
import numpy as np

from mjdrive.simulation.meshes import Shell
from mjdrive.town.scenery.blocks import Block

HIGHEST_GABLE = 10.0  # wall of a house with a pitched roof [m]
DEEPEST_GABLE = 13.0  # [m]
EAVES = 0.4  # overhang of a pitched roof [m]
PITCH = 0.62  # rise over run [-]
THICKNESS = 0.12  # of a pitched roof above the top of the wall [m]
CORNICE = (0.18, 0.35)  # overhang and height of the rim of a flat roof [m]
GRAVEL_ABOVE_RIM = 0.005  # [m]
STAIRHEAD = (3.2, 2.6, 2.2)  # length, depth and height of the box on a flat roof [m]
SMALLEST_WITH_STAIRHEAD = 10.0  # length and depth of the roof [m]


class Roofs:
    """Collects the roofs of all houses, by material."""

    def __init__(self) -> None:
        names = ("tiles", "slate", "gravel", "concrete")
        self._shells = {name: Shell() for name in names}

    def cover(self, house: Block, rng: np.random.Generator) -> None:
        """Put a roof on a house.

        Args:
            house: The house.
            rng: Draws the material and where stairs end.
        """
        if house.height <= HIGHEST_GABLE and min(house.length, house.depth) <= DEEPEST_GABLE:
            material = "tiles" if rng.uniform() < 0.65 else "slate"
            self._gable(house, self._shells[material])
        else:
            self._flat(house, rng.uniform(0.25, 0.75))

    def show(self, spec: mujoco.MjSpec) -> None:
        """Add all roofs to the scene."""
        for material, shell in self._shells.items():
            shell.show(spec, f"roofs_{material}", material=material)

    def _gable(self, house: Block, shell: Shell) -> None:
        """Ridge along the longer side."""
        length, depth = house.length + 2 * EAVES, house.depth + 2 * EAVES
        turned = depth > length
        run = 0.5 * min(length, depth)
        eaves = house.height - PITCH * EAVES + THICKNESS
        ridge = eaves + PITCH * run
        half = 0.5 * max(length, depth)
        low = [[half, -run, eaves], [half, run, eaves], [-half, run, eaves], [-half, -run, eaves]]
        right, left = [half, 0.0, ridge], [-half, 0.0, ridge]
        faces = (
            [low[3], low[0], right, left],
            [low[1], low[2], left, right],
            [low[0], low[1], right],
            [low[2], low[3], left],
            low[::-1],
        )
        yaw = house.yaw + (0.5 * np.pi if turned else 0.0)
        for face in faces:
            shell.polygon(_placed(house, np.array(face), yaw))

    def _flat(self, house: Block, stairs_share: float) -> None:
        """A rim of concrete around gravel, and the head of the stairs where there is room."""
        overhang, rise = CORNICE
        half = 0.5 * np.array([house.length, house.depth])
        rim = self._shells["concrete"]
        rim.box(
            _rectangle(house, half + overhang),
            bottom=house.height - 0.1,
            top=house.height + rise,
            floor=True,
        )
        gravel = np.column_stack(
            [_rectangle(house, half - 0.3), np.full(4, house.height + rise + GRAVEL_ABOVE_RIM)]
        )
        self._shells["gravel"].polygon(gravel)
        if min(house.length, house.depth) >= SMALLEST_WITH_STAIRHEAD:
            box = 0.5 * np.array(STAIRHEAD[:2])
            centre = np.array([(stairs_share - 0.5) * house.length, 0.0])
            top = house.height + rise + STAIRHEAD[2]
            rim.box(_rectangle(house, box, centre), bottom=house.height + rise, top=top)


def _rectangle(house: Block, half: np.ndarray, centre: np.ndarray | None = None) -> np.ndarray:
    """Rectangle parallel to a house, counter-clockwise, world frame [m]."""
    corners = half * np.array([[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]])
    if centre is not None:
        corners = corners + centre
    return _placed(house, np.column_stack([corners, np.zeros(4)]), house.yaw)[:, :2]


def _placed(house: Block, points: np.ndarray, yaw: float) -> np.ndarray:
    """Bring points from the frame of a house into the world frame."""
    cos, sin = np.cos(yaw), np.sin(yaw)
    turned = points @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    return turned + np.array([house.x, house.y, 0.0])
