"""Draw a town from above.

OpenCV draws it and Pillow writes on it: a figure library would take longer to load than a whole map takes to read.
"""

import io
from collections import defaultdict
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float, Int32, UInt8
from PIL import Image, ImageDraw, ImageFont

from mjdrive.config import require
from mjdrive.datatypes import Lane, Move, Town
from mjdrive.files import write_atomically
from mjdrive.town.surface import edges

Rgb = tuple[int, int, int]

MOVE_COLOURS: dict[Move, Rgb] = {
    Move.FOLLOW: (255, 255, 255),
    Move.LEFT: (76, 155, 232),
    Move.STRAIGHT: (88, 170, 88),
    Move.RIGHT: (240, 140, 50),
}
ROAD: Rgb = (196, 200, 206)
STOP_LINE: Rgb = (192, 57, 43)
INK: Rgb = (34, 34, 34)
PAPER: Rgb = (255, 255, 255)

LONGER_SIDE = 800
"""Of the map in a picture [px]."""

_MARGIN = 12.0  # around the lanes [m]
_FRAME = (56, 14, 14, 44)  # left, top, right and bottom of the map, for the scales [px]
_TICK = 4  # length [px]
_FEWEST_TICKS = 5  # along the longer side
_POLE = 1.5  # radius [px]
_LABEL = (10.0, -10.5)  # from the middle of a junction to its name, which then hides no lane [m]
_SMALLEST_SHIFT = 2.0  # scale at which the name stays that far away on smaller maps [px/m]
_FINEST_LABELLED = 0.5  # scale below which names of junctions would hide the town [px/m]
_TEXT, _SMALL_TEXT = 13, 11  # [px]
_SUBPIXELS = 4  # binary digits


def draw(town: Town) -> UInt8[np.ndarray, "H W 3"]:
    """Draw road, lanes, stop lines, poles and junction names, with scales in metres.

    Args:
        town: The town.

    Returns:
        RGB picture, north up.
    """
    sheet = Sheet(town)
    outlines = {name: np.concatenate(_both_edges(lane, sheet)) for name, lane in town.lanes.items()}
    for outline in outlines.values():
        # The outline closes the hairline gaps between neighbouring lanes.
        sheet.fill(outline, ROAD)
        sheet.line(outline, ROAD, closed=True)
    for lane in town.lanes.values():
        sheet.line(sheet.thinned(lane.centerline), MOVE_COLOURS[lane.move])
    for light in town.lights.values():
        sheet.line(light.stop_line, STOP_LINE)
    for light in town.lights.values():
        sheet.dot(light.pole, INK)
    sheet.finish(_junctions(town) if sheet.scale >= _FINEST_LABELLED else {})
    return sheet.image


def save(town: Town, path: Path) -> None:
    """Write the picture of a town as PNG.

    Args:
        town: The town.
        path: PNG file to write.

    Raises:
        ConfigError: If the file is to end in something else.
    """
    require(
        path.suffix.lower() == ".png",
        f"Cannot draw a town into '{path}'; expected a file that ends in .png.",
    )
    picture = io.BytesIO()
    Image.fromarray(draw(town)).save(picture, format="png")
    write_atomically(path, picture.getvalue())


def _both_edges(lane: Lane, sheet: "Sheet") -> tuple[Float[np.ndarray, "_ 2"], ...]:
    left, right = edges(lane)
    return sheet.thinned(left), sheet.thinned(right)[::-1]


def _junctions(town: Town) -> dict[str, Float[np.ndarray, "2"]]:
    """Middles of the junctions with lights, by name, world frame [m]."""
    with_lights = {light.junction for light in town.lights.values()}
    middles = defaultdict(list)
    for lane in town.lanes.values():
        if lane.junction in with_lights:
            middles[lane.junction].append(lane.centerline.mean(axis=0))
    return {name: np.mean(points, axis=0) for name, points in middles.items()}


class Sheet:
    """A picture to draw on in world coordinates.

    Args:
        town: The town that has to fit.

    Attributes:
        image: The picture so far.
        scale: Of the map [px/m].
    """

    def __init__(self, town: Town) -> None:
        west, south, east, north = (town.bounds + _MARGIN * np.array([-1, -1, 1, 1])).tolist()
        self.scale = LONGER_SIDE / max(east - west, north - south)
        left, top, right, bottom = _FRAME
        self._width, self._height = (
            round(self.scale * side) for side in (east - west, north - south)
        )
        self._north_west, self._origin = np.array([west, north]), np.array([left, top])
        self.image = np.full(
            (self._height + top + bottom, self._width + left + right, 3), PAPER, np.uint8
        )

    def thinned(self, points: Float[np.ndarray, "N 2"]) -> Float[np.ndarray, "_ 2"]:
        """Leave out points that half a pixel holds; those of lanes are up to half a metre apart."""
        step = max(1, int(1.0 / self.scale))
        return np.concatenate([points[:-1:step], points[-1:]])

    def fill(self, outline: Float[np.ndarray, "N 2"], colour: Rgb) -> None:
        """Fill an outline."""
        cv2.fillPoly(self.image, [self._fine(outline)], colour, cv2.LINE_AA, _SUBPIXELS)

    def line(
        self,
        points: Float[np.ndarray, "N 2"],
        colour: Rgb,
        *,
        closed: bool = False,
    ) -> None:
        """Draw a line."""
        cv2.polylines(self.image, [self._fine(points)], closed, colour, 1, cv2.LINE_AA, _SUBPIXELS)

    def dot(self, point: Float[np.ndarray, "2"], colour: Rgb) -> None:
        """Draw a dot."""
        (centre,) = self._fine(point[None]).tolist()
        radius = round(_POLE * 2**_SUBPIXELS)
        cv2.circle(self.image, centre, radius, colour, cv2.FILLED, cv2.LINE_AA, _SUBPIXELS)

    def finish(self, names: dict[str, Float[np.ndarray, "2"]]) -> None:
        """Write names beside places, and frame the map with scales."""
        page = Image.fromarray(self.image)
        pen = ImageDraw.Draw(page)
        font, small = (ImageFont.load_default(size) for size in (_TEXT, _SMALL_TEXT))
        for name, place in names.items():
            at = self.pixels(place[None])[0] + max(self.scale, _SMALLEST_SHIFT) * np.array(_LABEL)
            pen.text(tuple(at.tolist()), name, INK, small, anchor="mm")
        left, top = self._origin.tolist()
        right, bottom = left + self._width, top + self._height
        pen.rectangle((left, top, right, bottom), outline=INK)
        for value in _ticks(self._north_west[0], self._width, self.scale):
            x = left + (value - self._north_west[0]) * self.scale
            pen.line((x, bottom, x, bottom + _TICK), INK)
            pen.text((x, bottom + 2 * _TICK), f"{value:g}", INK, font, anchor="ma")
        for value in _ticks(
            self._north_west[1] - self._height / self.scale, self._height, self.scale
        ):
            y = top + (self._north_west[1] - value) * self.scale
            pen.line((left - _TICK, y, left, y), INK)
            pen.text((left - 2 * _TICK, y), f"{value:g}", INK, font, anchor="rm")
        pen.text(((left + right) / 2, bottom + 40), "x, y [m]", INK, font, anchor="mb")
        self.image = np.asarray(page)

    def pixels(self, points: Float[np.ndarray, "N 2"]) -> Float[np.ndarray, "N 2"]:
        """Where places of the world frame are, column and row [px]."""
        return self._origin + (points - self._north_west) * np.array([self.scale, -self.scale])

    def _fine(self, points: Float[np.ndarray, "N 2"]) -> Int32[np.ndarray, "N 2"]:
        """Pixels with `_SUBPIXELS` binary digits behind the point, as OpenCV wants them."""
        return np.rint(self.pixels(points) * 2**_SUBPIXELS).astype(np.int32)


def _ticks(start: float, length_px: int, scale: float) -> np.ndarray:
    """Round numbers along a side of the map [m]."""
    rough = LONGER_SIDE / scale / _FEWEST_TICKS
    power = 10.0 ** np.floor(np.log10(rough))
    step = power * max(factor for factor in (1.0, 2.0, 5.0) if factor * power <= rough)
    first, last = np.ceil(start / step), np.floor((start + length_px / scale) / step)
    return step * np.arange(first, last + 1.0) + 0.0  # which turns -0 into 0
