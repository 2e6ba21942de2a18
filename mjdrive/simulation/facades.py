"""Windows, doors and ground floors of houses.

The windows of a floor are one band: its texture alternates between glass and wall, so that a house of twenty windows
takes four faces and not twenty.
"""

from collections.abc import Sequence

import mujoco
import numpy as np

from mjdrive.simulation import palette
from mjdrive.simulation.blocks import add_block
from mjdrive.simulation.meshes import Shell
from mjdrive.simulation.roofs import Roofs
from mjdrive.simulation.walls import Wall, walls_of
from mjdrive.town.scenery.blocks import Block

FLOOR_HEIGHT = 3.3  # about [m]
WINDOW_PITCH = 2.7  # about, from one window to the next; half of it is glass [m]
WINDOW = (0.95, 2.5)  # lower and upper edge above the floor [m]
DOOR = (1.2, 2.3)  # width and height [m]
PLINTH_HEIGHT = 0.45  # [m]
FEWEST_FLOORS_WITH_SHOP = 4
PROUD = 0.004  # of windows and doors before the wall; more would throw a ragged shadow [m]
TEXTURE_ROW = (0.1, 0.4)  # within one row of the texture's squares [-]


def add_houses(spec: mujoco.MjSpec, houses: Sequence[Block], *, rng: np.random.Generator) -> None:
    """Stand houses with facades and roofs; the car can hit their walls.

    Args:
        spec: Scene with the materials of `palette`.
        houses: Where they stand; each looks to the left of its yaw.
        rng: Draws colours.
    """
    facades = Facades()
    roofs = Roofs()
    for number, house in enumerate(houses):
        color = int(rng.integers(len(palette.WALLS)))
        add_block(spec, f"building_{number}", house, material=palette.wall(color))
        facades.dress(walls_of(house), house.height, color, door_share=rng.uniform(0.2, 0.8))
        roofs.cover(house, rng)
    facades.show(spec, "facade")
    roofs.show(spec)


class Facades:
    """Collects what hangs on the walls of all houses, by material."""

    def __init__(self) -> None:
        self._windows = [Shell() for _ in (*palette.WALLS, palette.STONE)]
        self._stone, self._doors = Shell(), Shell()

    def dress(self, walls: Sequence[Wall], height: float, color: int, *, door_share: float) -> None:
        """Hang windows on every floor, and a door on the ground floor of the first wall.

        Args:
            walls: Sides of the house, counter-clockwise, its front first.
            height: Of the house [m].
            color: Index into `palette.WALLS`.
            door_share: Where the door is, as a share of the front [-].
        """
        num_floors = max(1, round(height / FLOOR_HEIGHT))
        floor_height = height / num_floors
        for side, wall in enumerate(walls):
            has_shop = side == 0 and num_floors >= FEWEST_FLOORS_WITH_SHOP
            stone_top = floor_height if has_shop else min(PLINTH_HEIGHT, height)
            self._stone.polygon(wall.panel(0.0, wall.width, 0.0, stone_top, proud=0.5 * PROUD))
            for floor in range(num_floors if floor_height > WINDOW[1] else 0):
                door = door_share if side == 0 and floor == 0 else None
                piers = palette.STONE_WINDOWS if has_shop and floor == 0 else color
                self._hang(wall, floor * floor_height, piers, door=door)

    def show(self, spec: mujoco.MjSpec, prefix: str) -> None:
        """Add everything to the scene.

        Args:
            spec: Scene with the materials of `palette`.
            prefix: Of the names of meshes and geoms.
        """
        for color, shell in enumerate(self._windows):
            shell.show(spec, f"{prefix}_windows_{color}", material=palette.windows(color))
        self._stone.show(spec, f"{prefix}_stone", material="stone")
        self._doors.show(spec, f"{prefix}_doors", material="door")

    def _hang(self, wall: Wall, floor: float, piers: int, *, door: float | None) -> None:
        """Hang the windows of one floor; a door takes the place of one."""
        num_windows = int(wall.width / WINDOW_PITCH)
        pitch = wall.width / max(num_windows, 1)
        bottom, top = floor + WINDOW[0], floor + WINDOW[1]
        bands = [(0, num_windows)]
        if door is not None and num_windows:
            slot = int(door * num_windows)
            middle = (slot + 0.5) * pitch
            sides = middle - 0.5 * DOOR[0], middle + 0.5 * DOOR[0]
            self._doors.polygon(wall.panel(*sides, 0.0, DOOR[1], proud=PROUD))
            bands = [(0, slot), (slot + 1, num_windows)]
        for first, last in bands:
            if first < last:
                glass = (first + 0.25) * pitch, (last - 0.25) * pitch
                panel = wall.panel(*glass, bottom, top, proud=PROUD)
                self._windows[piers].polygon(panel, texture=_texture(last - first))


def _texture(num_windows: int) -> np.ndarray:
    """Glass and piers in turn, glass at both ends."""
    right = num_windows - 0.5
    low, high = TEXTURE_ROW
    return np.array([[0.0, low], [right, low], [right, high], [0.0, high]])
