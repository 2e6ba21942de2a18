"""Everything of a town that stands still, drawn once from above; a view is a turned cut-out of it."""

from dataclasses import dataclass

import cv2
import numpy as np
import shapely
from jaxtyping import Float, UInt8, UInt16

from mjdrive.bev.layers import MARKED, Layer
from mjdrive.config import BevConfig
from mjdrive.datatypes import Town
from mjdrive.errors import TownFormatError
from mjdrive.town import surface

_LANES_MARGIN = 15.0
"""Empty border around the lanes; the outline of the road needs 0.5 m [m]."""

_SCENERY_MARGIN = 60.0
"""Border with sidewalks and houses around the lanes [m]."""

LARGEST_RASTER = 200_000_000
"""Most pixels of a raster of a town, about 2.8 km by 2.8 km at 5 px/m; drawing it takes some 8 bytes each [px]."""

_LINE_GAIN = np.uint16(255)
"""How much stronger than the road a lane line is where both share a raster; see `_road_and_lines`."""


@dataclass(frozen=True, slots=True, eq=False)
class Raster:
    """A picture of a whole town, north up.

    Attributes:
        image: One or more layers as grey levels.
        world_from_raster: From (column, row) [px] to the world frame [m].
        thresholds: Channel of the view and the level above which a pixel of the image belongs to it.
    """

    image: UInt8[np.ndarray, "H W"] | UInt16[np.ndarray, "H W"]
    world_from_raster: Float[np.ndarray, "3 3"]
    thresholds: tuple[tuple[int, int], ...]

    def draw(
        self, bev: UInt8[np.ndarray, "C S S"], view_from_world: Float[np.ndarray, "3 3"]
    ) -> None:
        """Draw the layers of this raster into their channels of a view."""
        view_from_raster = view_from_world @ self.world_from_raster
        # Any touched pixel counts, as in the original, so thin lines stay unbroken at every angle.
        cut = cv2.warpAffine(self.image, view_from_raster[:2], bev.shape[1:])
        for channel, threshold in self.thresholds:
            np.greater(cut, threshold, out=bev[channel].view(np.bool_))
            bev[channel] *= np.uint8(MARKED)


def require_drawable(town: Town, config: BevConfig | None = None) -> None:
    """Refuse a town that is too large to draw as a whole.

    Args:
        town: Road network.
        config: How the view is drawn; as the paper does if None.

    Raises:
        TownFormatError: If the raster of its lanes would have more than `LARGEST_RASTER` pixels.
    """
    scale = (config or BevConfig()).pixels_per_metre
    width, height = _Canvas(town, _LANES_MARGIN, scale).size_px
    if width * height > LARGEST_RASTER:
        raise TownFormatError(
            f"Town '{town.name}' covers {width / scale:.0f} m by {height / scale:.0f} m, {width * height / 1e6:.0f} "
            f"million pixels seen from above; expected {LARGEST_RASTER / 1e6:.0f} million or fewer, "
            f"{LARGEST_RASTER / scale**2 / 1e6:.1f} square kilometres. Cut the map into parts and import each."
        )


def draw_lanes(town: Town, config: BevConfig) -> tuple[Raster, ...]:
    """Draw the road and lane-line channels of a town.

    Each lane is filled and outlined; lane lines are both edges of every lane outside junctions, 1 px wide.

    Args:
        town: Road network.
        config: How the view is drawn.

    Returns:
        One raster with both layers, or two where the outline is too narrow for that.

    Raises:
        TownFormatError: If the town is too large.
    """
    require_drawable(town, config)
    canvas = _Canvas(town, _LANES_MARGIN, config.pixels_per_metre)
    road, lane_lines = canvas.blank(), canvas.blank()
    for lane in town.lanes.values():
        left, right = (canvas.pixels(edge) for edge in surface.edges(lane))
        outline = np.concatenate([left, right[::-1]])
        cv2.fillPoly(road, [outline], MARKED)
        if config.road_outline_px:
            # Of an even thickness OpenCV makes the next odd number of pixels, of an odd one, above 1, two more.
            thickness = max(config.road_outline_px - 1, 1)
            cv2.polylines(road, [outline], True, MARKED, thickness)
        if lane.junction is None:
            cv2.polylines(lane_lines, [left, right], False, MARKED, 1)
    return _road_and_lines(road, lane_lines, canvas.world_from_raster)


def draw_area(town: Town, area: shapely.Geometry, channel: int, config: BevConfig) -> Raster:
    """Draw a channel that shows the ground under something.

    Args:
        town: Road network that the area surrounds.
        area: Polygon or several, holes allowed, world frame [m].
        channel: Of the view.
        config: How the view is drawn.

    Returns:
        Raster of the one layer.
    """
    canvas = _Canvas(town, _SCENERY_MARGIN, config.pixels_per_metre)
    image = canvas.blank()
    for polygon in shapely.get_parts(area):
        # One call a polygon: with holes an inner outline takes away what an outer one fills.
        rings = [polygon.exterior, *polygon.interiors]
        cv2.fillPoly(
            image, [canvas.pixels(shapely.get_coordinates(ring)) for ring in rings], MARKED
        )
    return Raster(image, canvas.world_from_raster, ((channel, 0),))


class _Canvas:
    """Maps world coordinates to pixels of a raster around the lanes of a town."""

    def __init__(self, town: Town, margin: float, pixels_per_metre: float) -> None:
        left, bottom, right, top = town.bounds + np.array([-1, -1, 1, 1]) * margin
        scale = pixels_per_metre
        extent = np.array([right - left, top - bottom]) * scale
        self.size_px: tuple[int, int] = tuple(np.ceil(extent).astype(int).tolist())
        self._raster_from_world = np.array(
            [[scale, 0.0, -scale * left], [0.0, -scale, scale * top], [0.0, 0.0, 1.0]]
        )
        self.world_from_raster = np.linalg.inv(self._raster_from_world)

    def blank(self) -> UInt8[np.ndarray, "H W"]:
        width, height = self.size_px
        return np.zeros((height, width), np.uint8)

    def pixels(self, points: Float[np.ndarray, "N 2"]) -> np.ndarray:
        raster = points @ self._raster_from_world[:2, :2].T + self._raster_from_world[:2, 2]
        return np.rint(raster).astype(np.int32)


def _road_and_lines(
    road: UInt8[np.ndarray, "H W"],
    lane_lines: UInt8[np.ndarray, "H W"],
    world_from_raster: Float[np.ndarray, "3 3"],
) -> tuple[Raster, ...]:
    """Put both layers into one raster, because the warp is what a frame costs.

    Where all neighbours of a line are road, a warped pixel that touches the line by the share w reads
    255 + 255 * 255 w before rounding, and one that does not reads at most 255. In a raster of its own the line reads
    255 w and shows above 0.5: here that is above 255 + 127.5, so rounding turns on the same pixels.
    """
    inner_road = cv2.erode(road, np.ones((3, 3), np.uint8))
    if np.any(lane_lines > inner_road):
        return (
            Raster(road, world_from_raster, ((Layer.ROAD, 0),)),
            Raster(lane_lines, world_from_raster, ((Layer.LANE_LINES, 0),)),
        )
    both = road + _LINE_GAIN * lane_lines.astype(np.uint16)
    line_threshold = MARKED + int(_LINE_GAIN) // 2
    return (Raster(both, world_from_raster, ((Layer.ROAD, 0), (Layer.LANE_LINES, line_threshold))),)
