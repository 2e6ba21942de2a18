"""Town + pose + time -> the channels that a policy sees. A pure function: nothing is remembered between calls.

Source of the conventions: Roach's chauffeurnet renderer and the paper's configuration of it (five channels, history
-16, -9, -1 at 10 Hz; docs/decisions.md); the rasters are drawn once, every frame is one affine warp.
"""

import math
from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, UInt8

from mjdrive.bev.extras import draw_route, draw_vehicles, scenery_rasters
from mjdrive.bev.layers import channel_names
from mjdrive.bev.rasters import draw_lanes
from mjdrive.bev.stop_lines import StopLines
from mjdrive.config import BevConfig
from mjdrive.datatypes import Episode, Town
from mjdrive.errors import ConfigError
from mjdrive.town.scenery import Scenery
from mjdrive.town.scenery.blocks import Block


class BevProjector:
    """Draws the bird's-eye view of one town.

    Args:
        town: Road network to draw.
        control_interval: Time between two decisions, the unit of the light history [s].
        config: How the view is drawn.
        scenery: What stands beside the roads, for the extra layers "sidewalks" and "buildings".

    Attributes:
        config: How the view is drawn.
        channels: Name of each channel, in order.

    Raises:
        ConfigError: If an extra layer shows scenery and none is given.
    """

    def __init__(
        self,
        town: Town,
        *,
        control_interval: float = 0.1,
        config: BevConfig | None = None,
        scenery: Scenery | None = None,
    ) -> None:
        self.config = config or BevConfig()
        self.channels = channel_names(self.config)
        self._rasters = (
            draw_lanes(town, self.config),
            *scenery_rasters(town, scenery, self.channels, self.config),
        )
        self._stop_lines = StopLines(town, control_interval=control_interval, config=self.config)
        self._view_from_vehicle = _view_from_vehicle(self.config)

    def project(
        self,
        *,
        x: float,
        y: float,
        yaw: float,
        time: float,
        light_phase: float,
        route: Float[np.ndarray, "N 2"] | None = None,
        vehicles: Sequence[Block] = (),
    ) -> UInt8[np.ndarray, "C S S"]:
        """Draw what the car sees.

        Args:
            x: Rear-axle centre, world frame [m].
            y: Rear-axle centre, world frame [m].
            yaw: Heading [rad].
            time: Simulation time since reset [s]; the light history does not reach before 0.
            light_phase: Time into the light cycle at reset [s].
            route: Points of the way to go, world frame, for the extra layer "route" [m].
            vehicles: Other vehicles as boxes, for the extra layer "vehicles".

        Returns:
            Channels in the order of `channels`, row 0 farthest ahead, column 0 farthest left.

        Raises:
            ConfigError: If a route or vehicles are given without their layer, or the layer without a route.
        """
        self._refuse_misfits(route, vehicles)
        view_from_world = self.view_from_world(x=x, y=y, yaw=yaw)
        bev = np.zeros((len(self.channels), self.config.size_px, self.config.size_px), np.uint8)
        for raster in self._rasters:
            raster.draw(bev, view_from_world)
        ahead = self.config.origin_ahead_of_rear_axle
        self._stop_lines.draw(
            bev,
            view_from_world,
            ego_world=(x + ahead * math.cos(yaw), y + ahead * math.sin(yaw)),
            time=time,
            light_phase=light_phase,
        )
        if route is not None:
            draw_route(bev[self.channels.index("route")], view_from_world, route)
        if vehicles:
            draw_vehicles(bev[self.channels.index("vehicles")], view_from_world, vehicles)
        return bev

    def replay(self, episode: Episode, step: int) -> UInt8[np.ndarray, "C S S"]:
        """Draw what was seen when an action of a drive was chosen.

        Args:
            episode: Driven in this town.
            step: Which action, from 0 [-].

        Raises:
            ConfigError: If the view has a layer for the route, which episodes do not hold.
        """
        x, y, yaw = episode.vehicle[step, :3].tolist()
        return self.project(
            x=x, y=y, yaw=yaw, time=float(episode.time[step]), light_phase=episode.light_phase
        )

    def view_from_world(self, *, x: float, y: float, yaw: float) -> Float[np.ndarray, "3 3"]:
        """Tell where a view shows the world: `view_from_world @ (x, y, 1)` is (column, row, 1).

        Whole numbers are the middles of pixels; column 0 is farthest left, row 0 farthest ahead.

        Args:
            x: Rear-axle centre of the car, world frame [m].
            y: Rear-axle centre of the car, world frame [m].
            yaw: Heading of the car [rad].

        Returns:
            Homogeneous transform from the world frame [m] to the view [px].
        """
        cos, sin = math.cos(yaw), math.sin(yaw)
        rows = (cos, sin, -cos * x - sin * y, -sin, cos, sin * x - cos * y, 0.0, 0.0, 1.0)
        vehicle_from_world = np.array(rows).reshape(3, 3)
        return self._view_from_vehicle @ vehicle_from_world

    def _refuse_misfits(
        self, route: Float[np.ndarray, "N 2"] | None, vehicles: Sequence[Block]
    ) -> None:
        if (route is not None) != ("route" in self.channels):
            raise ConfigError(
                f"A view of {', '.join(self.channels)} was asked for "
                f"{'without' if route is None else 'with'} a route; expected a route exactly where "
                f"BevConfig.extra_layers has 'route'."
            )
        if vehicles and "vehicles" not in self.channels:
            raise ConfigError(
                f"{len(vehicles)} vehicles were given to a view of {', '.join(self.channels)}; "
                f"add 'vehicles' to BevConfig.extra_layers."
            )


def _view_from_vehicle(config: BevConfig) -> Float[np.ndarray, "3 3"]:
    scale = config.pixels_per_metre
    column = config.size_px / 2
    row = config.size_px - config.ego_above_bottom_px + scale * config.origin_ahead_of_rear_axle
    # vehicle y is left of the car: columns fall with y, rows fall with x.
    return np.array([[0.0, -scale, column], [-scale, 0.0, row], [0.0, 0.0, 1.0]])
