"""Everything of a town that stands still, drawn once from above; a view is a turned cut-out of it."""

from collections.abc import Mapping
from dataclasses import dataclass

import cv2
import numpy as np
import shapely
from jaxtyping import Float, UInt8

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


@dataclass(frozen=True, slots=True, eq=False)
class Raster:
    """A picture of a whole town, north up, with a bit for each of up to eight layers.

    A pixel of a view shows a layer if any of the four pixels of the drawn layer around its place does, as in the
    original, so that thin lines stay unbroken at every angle. That is settled here once: a pixel of `image` stands for
    the corner that four drawn pixels share, so the nearest one tells.

    Attributes:
        image: Bit n of each pixel belongs to layer n.
        world_from_raster: From (column, row) of the image [px] to the world frame [m].
        channels: Channel of the view of each layer.
    """

    image: UInt8[np.ndarray, "H W"]
    world_from_raster: Float[np.ndarray, "3 3"]
    channels: tuple[int, ...]

    @staticmethod
    def of_layers(
        layers: Mapping[int, UInt8[np.ndarray, "H W"]],
        world_from_drawn: Float[np.ndarray, "3 3"],
    ) -> "Raster":
        """Put drawn layers into one raster.

        Args:
            layers: Pictures of the layers, not 0 where a pixel is marked, by channel of the view; empty at the edges.
            world_from_drawn: From (column, row) of the pictures [px] to the world frame [m].
        """
        assert len(layers) <= 8, f"{len(layers)} layers do not fit into 8 bits"
        # An anchor of (0, 0) makes pixel (c, r) the largest of the four from (c, r) to (c + 1, r + 1).
        square, anchor = np.ones((2, 2), np.uint8), (0, 0)
        touched = [cv2.dilate(layer, square, anchor=anchor) > 0 for layer in layers.values()]
        bits = [np.uint8(1 << number) * layer for number, layer in enumerate(touched)]
        image = np.bitwise_or.reduce(bits)
        corner = np.array([[1.0, 0.0, 0.5], [0.0, 1.0, 0.5], [0.0, 0.0, 1.0]])
        return Raster(image, world_from_drawn @ corner, tuple(layers))

    def draw(
        self, bev: UInt8[np.ndarray, "C S S"], view_from_world: Float[np.ndarray, "3 3"]
    ) -> None:
        """Draw the layers of this raster into their channels of a view."""
        view_from_raster = view_from_world @ self.world_from_raster
        size = bev.shape[1:]
        cut = np.empty(size, np.uint8)
        cv2.warpAffine(self.image, view_from_raster[:2], size, cut, cv2.INTER_NEAREST)
        *lower, last = self.channels
        below_last = (1 << len(lower)) - 1
        cv2.threshold(cut, below_last, MARKED, cv2.THRESH_BINARY, dst=bev[last])
        for number, channel in enumerate(lower):
            bit = cut & np.uint8(1 << number)
            cv2.threshold(bit, 0, MARKED, cv2.THRESH_BINARY, dst=bev[channel])


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


def draw_lanes(town: Town, config: BevConfig) -> Raster:
    """Draw the road and lane-line channels of a town; see `lane_layers`.

    Args:
        town: Road network.
        config: How the view is drawn.

    Returns:
        Raster of both layers.

    Raises:
        TownFormatError: If the town is too large.
    """
    require_drawable(town, config)
    return Raster.of_layers(*lane_layers(town, config))


def lane_layers(
    town: Town, config: BevConfig
) -> tuple[dict[int, UInt8[np.ndarray, "H W"]], Float[np.ndarray, "3 3"]]:
    """Draw all lanes of a town from above, north up.

    Each lane is filled and outlined; lane lines are both edges of every lane outside junctions, 1 px wide.

    Args:
        town: Road network, not too large to draw.
        config: How the view is drawn.

    Returns:
        Pictures of road and lane lines by channel, and from their (column, row) [px] to the world frame [m].
    """
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
    return {Layer.ROAD: road, Layer.LANE_LINES: lane_lines}, canvas.world_from_raster


def draw_areas(town: Town, areas: Mapping[int, shapely.Geometry], config: BevConfig) -> Raster:
    """Draw channels that show the ground under something.

    Args:
        town: Road network that the areas surround.
        areas: Polygon or several, holes allowed, world frame [m], by channel of the view.
        config: How the view is drawn.

    Returns:
        Raster of all of them.
    """
    canvas = _Canvas(town, _SCENERY_MARGIN, config.pixels_per_metre)
    layers = {channel: canvas.blank() for channel in areas}
    for channel, area in areas.items():
        for polygon in shapely.get_parts(area):
            # One call a polygon: with holes an inner outline takes away what an outer one fills.
            rings = [polygon.exterior, *polygon.interiors]
            corners = [canvas.pixels(shapely.get_coordinates(ring)) for ring in rings]
            cv2.fillPoly(layers[channel], corners, MARKED)
    return Raster.of_layers(layers, canvas.world_from_raster)


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
