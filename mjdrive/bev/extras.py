"""Channels beside the paper's five, all off by default: route, sidewalks, buildings, vehicles."""

from collections.abc import Sequence

import cv2
import numpy as np
import shapely
from jaxtyping import Float, UInt8

from mjdrive.bev.layers import MARKED
from mjdrive.bev.rasters import Raster, draw_areas
from mjdrive.config import BevConfig
from mjdrive.datatypes import Town
from mjdrive.errors import ConfigError
from mjdrive.town.scenery import Scenery
from mjdrive.town.scenery.blocks import Block

ROUTE_WIDTH_PX = 16
"""Width of a drawn route, as in Roach [px]."""


def scenery_rasters(
    town: Town, scenery: Scenery | None, channels: Sequence[str], config: BevConfig
) -> tuple[Raster, ...]:
    """Draw the channels that show scenery, once.

    Args:
        town: Road network.
        scenery: What stands beside its roads.
        channels: Name of each channel of a view.
        config: How the view is drawn.

    Returns:
        A raster of "sidewalks" and "buildings", as far as they are among the channels; none if neither is.

    Raises:
        ConfigError: If there is such a channel and no scenery.
    """
    wanted = [name for name in ("sidewalks", "buildings") if name in channels]
    if not wanted:
        return ()
    if scenery is None:
        raise ConfigError(
            f"BevConfig.extra_layers has {' and '.join(wanted)}, but no scenery was given; expected "
            f"what mjdrive.town.scenery.lay_out returns for the town."
        )
    areas = {
        "sidewalks": scenery.sidewalk,
        "buildings": shapely.union_all([house.footprint() for house in scenery.buildings]),
    }
    return (draw_areas(town, {channels.index(name): areas[name] for name in wanted}, config),)


def draw_route(
    channel: UInt8[np.ndarray, "S S"],
    view_from_world: Float[np.ndarray, "3 3"],
    route: Float[np.ndarray, "N 2"],
) -> None:
    """Draw the way to go as a broad line.

    Args:
        channel: Channel to draw into.
        view_from_world: From the world frame [m] to (column, row) [px].
        route: Points along it, world frame [m].
    """
    cv2.polylines(channel, [_pixels(route, view_from_world)], False, MARKED, ROUTE_WIDTH_PX)


def draw_vehicles(
    channel: UInt8[np.ndarray, "S S"],
    view_from_world: Float[np.ndarray, "3 3"],
    vehicles: Sequence[Block],
) -> None:
    """Draw the ground that vehicles cover.

    Args:
        channel: Channel to draw into.
        view_from_world: From the world frame [m] to (column, row) [px].
        vehicles: Their boxes in the world frame.
    """
    for vehicle in vehicles:
        cv2.fillConvexPoly(channel, _pixels(vehicle.corners(), view_from_world), MARKED)


def _pixels(
    points: Float[np.ndarray, "N 2"], view_from_world: Float[np.ndarray, "3 3"]
) -> np.ndarray:
    view = points @ view_from_world[:2, :2].T + view_from_world[:2, 2]
    return np.rint(view).astype(np.int32)
