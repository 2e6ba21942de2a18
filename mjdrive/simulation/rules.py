"""The rules of a drive: red lights, collisions, kerbs and leaving the road.

Red lights follow the Leaderboard 1.0 criterion (docs/decisions.md); what counts as off the road is stricter than there: the
centre of the car outside every driving lane and the gaps between the lanes of a junction, where the Leaderboard allows 1.3 m beyond the lane.
"""

from collections.abc import Iterable, Mapping

import numpy as np
import shapely
from jaxtyping import Float

from mjdrive.config import RulesConfig
from mjdrive.datatypes import Infraction, InfractionKind, Signal, Town, TrafficLight, VehicleState
from mjdrive.town import surface
from mjdrive.vehicle.parameters import VehicleParameters


class Rules:
    """Watches one drive and reports each breach once.

    Args:
        town: Where the drive takes place.
        parameters: Size of the car.
        config: Limits of the rules.
    """

    def __init__(
        self, town: Town, parameters: VehicleParameters, config: RulesConfig | None = None
    ) -> None:
        self.config = config or RulesConfig()
        self._lights = tuple(town.lights.values())
        middles = [light.stop_line.mean(axis=0) for light in self._lights]
        self._stop_points = np.array(middles).reshape(-1, 2)
        self._half_length = parameters.length / 2
        self._centre_ahead = parameters.length / 2 - parameters.rear_overhang
        self._surface = surface.road_surface(town, shoulder=0.0)
        self._approaches = surface.lane_polygons(town)
        shapely.prepare(self._surface)
        for light in town.lights.values():
            shapely.prepare(self._approaches[light.lane])
        self.reset()

    def reset(self) -> None:
        """Forget the drive so far."""
        self._last_light_run: str | None = None
        self._was_on_lane = True
        self._last_hit: dict[tuple[InfractionKind, str], tuple[float, float, float]] = {}

    def on_lane(self, vehicle: VehicleState) -> bool:
        """Whether the centre of the car is on a driving lane."""
        x, y = self._behind_centre(vehicle, 0.0)
        return bool(shapely.contains_xy(self._surface, x, y))

    def check(
        self,
        *,
        time: float,
        vehicle: VehicleState,
        lights: Mapping[str, Signal],
        hits: Iterable[tuple[InfractionKind, str]],
    ) -> tuple[Infraction, ...]:
        """Judge one control step.

        Args:
            time: Simulation time since reset [s].
            vehicle: State of the car at the end of the step.
            lights: What every light shows now.
            hits: Kind and name of everything that the car touched during the step.

        Returns:
            The breaches that are new in this step.
        """
        found: list[tuple[InfractionKind, str]] = []
        red_light = self._red_light_run(vehicle, lights)
        if red_light is not None:
            found.append((InfractionKind.RED_LIGHT, red_light))
        found += [hit for hit in hits if self._is_new_hit(hit, time, vehicle)]
        is_on_lane = self.on_lane(vehicle)
        if self._was_on_lane and not is_on_lane:
            found.append((InfractionKind.OFF_ROAD, ""))
        self._was_on_lane = is_on_lane
        return tuple(Infraction(kind, time, vehicle.x, vehicle.y, name) for kind, name in found)

    def _behind_centre(self, vehicle: VehicleState, distance: float) -> tuple[float, float]:
        """Point on the car's axis, `distance` behind the centre of its footprint [m]."""
        ahead = self._centre_ahead - distance
        return (
            vehicle.x + ahead * float(np.cos(vehicle.yaw)),
            vehicle.y + ahead * float(np.sin(vehicle.yaw)),
        )

    def _red_light_run(self, vehicle: VehicleState, lights: Mapping[str, Signal]) -> str | None:
        near_tail = np.array(self._behind_centre(vehicle, 0.8 * self._half_length))
        far_tail = np.array(self._behind_centre(vehicle, self._half_length + 1.0))
        distance = np.hypot(*(self._stop_points - self._behind_centre(vehicle, 0.0)).T)
        for index in np.flatnonzero(distance <= self.config.light_distance):
            light = self._lights[index]
            if lights[light.id] is not Signal.RED or light.id == self._last_light_run:
                continue
            on_approach = shapely.contains_xy(self._approaches[light.lane], *far_tail)
            along = np.cos(vehicle.yaw - light.yaw) > 0
            if on_approach and along and self._crosses(light, near_tail, far_tail):
                self._last_light_run = light.id
                return light.id
        return None

    def _crosses(
        self,
        light: TrafficLight,
        near_tail: Float[np.ndarray, "2"],
        far_tail: Float[np.ndarray, "2"],
    ) -> bool:
        middle = light.stop_line.mean(axis=0)
        watched = middle + 2 * self.config.stop_line_share * (light.stop_line - middle)
        return bool(
            shapely.LineString(watched).intersects(shapely.LineString([near_tail, far_tail]))
        )

    def _is_new_hit(
        self, hit: tuple[InfractionKind, str], time: float, vehicle: VehicleState
    ) -> bool:
        """Whether a touch is a new event: not the same thing within 5 s or 3 m of the last touch."""
        before = self._last_hit.get(hit)
        self._last_hit[hit] = (time, vehicle.x, vehicle.y)
        if before is None:
            return True
        moved = np.hypot(vehicle.x - before[1], vehicle.y - before[2])
        return bool(
            time - before[0] > self.config.same_hit_time and moved > self.config.same_hit_distance
        )
