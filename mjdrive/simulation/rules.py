"""The rules of a drive: red lights, collisions, kerbs, leaving the road, the wrong way, and getting stuck.

Each rule has a file of its own; what counts, and where it differs from the Leaderboard, is argued in docs/decisions.md.
"""

import math
from collections.abc import Collection, Mapping

from mjdrive.config import RulesConfig
from mjdrive.datatypes import Infraction, InfractionKind, Signal, Town, VehicleState
from mjdrive.simulation.off_road import OffRoadWatch
from mjdrive.simulation.red_lights import RedLightWatch
from mjdrive.simulation.standstill import StandstillWatch
from mjdrive.simulation.touches import TouchWatch
from mjdrive.simulation.wrong_way import WrongWayWatch
from mjdrive.town.foothold import Foothold
from mjdrive.town.lane_index import LaneIndex
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
        self._centre_ahead = parameters.length / 2 - parameters.rear_overhang
        index = LaneIndex(town)
        self._red_lights = RedLightWatch(
            town, index, half_length=parameters.length / 2, config=self.config
        )
        self._touches = TouchWatch(self.config)
        self._off_road = OffRoadWatch(town, index, self.config)
        self._foothold = Foothold(index)
        self._wrong_way = WrongWayWatch(index, self._foothold, self.config)
        self._standstill = StandstillWatch(self.config)

    def reset(self) -> None:
        """Forget the drive so far."""
        self._red_lights.reset()
        self._touches.reset()
        self._off_road.reset()
        self._wrong_way.reset()
        self._standstill.reset()

    def on_lane(self, vehicle: VehicleState) -> bool:
        """Whether the centre of the car is on the road: on a driving lane or in the gaps of a junction."""
        return self._off_road.on_road(self._centre(vehicle))

    def check(
        self,
        *,
        time: float,
        vehicle: VehicleState,
        lights: Mapping[str, Signal],
        hits: Collection[tuple[InfractionKind, str]],
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
        centre = self._centre(vehicle)
        in_lane = self._foothold.holds(*centre, vehicle.yaw)
        causes = (
            (InfractionKind.RED_LIGHT, self._red_lights.check(centre, vehicle.yaw, lights)),
            *self._touches.check(time, (vehicle.x, vehicle.y), hits),
            (InfractionKind.OFF_ROAD, self._off_road.check(centre, in_lane=in_lane)),
            (
                InfractionKind.WRONG_WAY,
                self._wrong_way.check(centre, vehicle.yaw, in_lane=in_lane),
            ),
            (InfractionKind.STUCK, self._standstill.check(time, vehicle.speed)),
        )
        return tuple(
            Infraction(kind, time, vehicle.x, vehicle.y, cause)
            for kind, cause in causes
            if cause is not None
        )

    def _centre(self, vehicle: VehicleState) -> tuple[float, float]:
        """Centre of the footprint, world frame [m]."""
        return (
            float(vehicle.x + self._centre_ahead * math.cos(vehicle.yaw)),
            float(vehicle.y + self._centre_ahead * math.sin(vehicle.yaw)),
        )
