"""One car in one town, stepped ten times a second."""

from collections.abc import Callable, Mapping
from typing import NamedTuple

import mujoco
import numpy as np
from jaxtyping import Float

from mjdrive import geometry
from mjdrive.bev.projector import BevProjector
from mjdrive.config import SimulationConfig
from mjdrive.datatypes import Action, Infraction, Observation, Signal, Town, VehicleState
from mjdrive.errors import RouteError
from mjdrive.simulation import scene
from mjdrive.simulation.contacts import ContactWatch, Hit
from mjdrive.simulation.lamps import set_lamps
from mjdrive.simulation.rules import Rules
from mjdrive.town import library, signals
from mjdrive.town.settings import TownSettings
from mjdrive.vehicle import cars
from mjdrive.vehicle.car import Car
from mjdrive.vehicle.cars import CarModel
from mjdrive.vehicle.engine import require_sane

_STANDING = Action(acceleration=0.0, steering=0.0)


class Snapshot(NamedTuple):
    """What `Simulation.restore` needs to drive on bit by bit as before; the rules start afresh.

    Attributes:
        physics: State of MuJoCo and of the car, shape (S,).
        num_steps: Control steps since reset [-].
        light_phase: Time into the light cycle at reset [s].
        action: The last action taken.
    """

    physics: Float[np.ndarray, " S"]
    num_steps: int
    light_phase: float
    action: Action


class Simulation:
    """A town with one car under MuJoCo physics.

    Args:
        town: Where to drive.
        config: Time steps.
        settings: What stands beside the roads; what town.json says if None.
        car: Which car; the default one if None.
    """

    def __init__(
        self,
        town: Town,
        config: SimulationConfig | None = None,
        *,
        settings: TownSettings | None = None,
        car: CarModel | None = None,
    ) -> None:
        self.town = town
        self.config = config or SimulationConfig()
        self.car_model = car or cars.load()
        spec = scene.build_scene(
            town,
            settings or library.load_settings(town.name),
            timestep=self.config.timestep,
            car=self.car_model.path,
        )
        self.model = scene.compile_scene(spec)
        self.data = mujoco.MjData(self.model)
        self.car = Car(self.model, self.data)
        self._projector = BevProjector(town, control_interval=self.config.control_interval)
        self._rules = Rules(town, self.car.parameters)
        self._contacts = ContactWatch(self.model, self.data)
        self._warnings = self.data.warning.number  # memory of MuJoCo
        self._num_steps = 0
        self._action = _STANDING
        self._shown: Mapping[str, Signal] = {}
        self.light_phase = 0.0

    def reset(self, *, lane: str, station: float, seed: int) -> None:
        """Put the car at rest on the centre of a lane.

        Args:
            lane: Name of the lane.
            station: Place of the rear axle along it [m].
            seed: Decides the time into the light cycle.

        Raises:
            RouteError: If the town has no such lane, the station is not on it, or something solid stands there.
        """
        if lane not in self.town.lanes:
            raise RouteError(
                f"Town '{self.town.name}' has no lane '{lane}'. Choose one of Town.lanes."
            )
        points = self.town.lanes[lane].centerline
        along = geometry.stations(points)
        if not 0.0 <= station <= along[-1]:
            raise RouteError(
                f"Station {station} m is not on lane '{lane}', which is {along[-1]:.1f} m long."
            )
        x, y = (float(np.interp(station, along, points[:, axis])) for axis in (0, 1))
        yaw = float(np.interp(station, along, np.unwrap(geometry.headings(points))))
        self.place(x=x, y=y, yaw=geometry.wrap_angle(yaw), seed=seed)

    def place(self, *, x: float, y: float, yaw: float, seed: int) -> None:
        """Put the car at rest anywhere and start a new drive.

        Args:
            x: Rear-axle centre, world frame [m].
            y: Rear-axle centre, world frame [m].
            yaw: Heading [rad].
            seed: Decides the time into the light cycle.

        Raises:
            RouteError: If something solid is where the car would stand.
        """
        self.car.place(x, y, yaw)
        in_the_way = self._contacts.obstacles()
        if in_the_way:
            raise RouteError(
                f"The car cannot start at ({x:.1f}, {y:.1f}) in {self.town.name}: {', '.join(in_the_way)} stands there. "
                f"Expected free ground; start elsewhere, or move what stands on the lane (`mjdrive towns check`)."
            )
        self.light_phase = signals.phase(self.town, seed)
        self._num_steps = 0
        self._action = _STANDING
        self._rules.reset()
        self._light_lamps()

    def step(
        self, action: Action, *, on_motion: Callable[[], None] | None = None
    ) -> tuple[Infraction, ...]:
        """Drive for one control interval.

        Args:
            action: What to do; values beyond [-1, 1] are clipped.
            on_motion: Called some fifty times a second of the simulation, for whoever watches the car move.

        Returns:
            The infractions of this interval.

        Raises:
            PhysicsError: If the physics has become unstable.
        """
        config = self.config
        self._action = Action(
            acceleration=min(max(float(action.acceleration), -1.0), 1.0),
            steering=min(max(float(action.steering), -1.0), 1.0),
        )
        self.car.command(self._action)
        hits: set[Hit] = set()
        num_substeps = round(config.car_update_interval / config.timestep)
        for _ in range(round(config.control_interval / config.car_update_interval)):
            self.car.update()
            mujoco.mj_step(self.model, self.data, num_substeps)
            if not self.car.is_clear:
                hits |= self._contacts.hits()
            if on_motion is not None:
                on_motion()
        if np.count_nonzero(self._warnings):
            require_sane(self.data)
        self._num_steps += 1
        self._light_lamps()
        return self._rules.check(
            time=self.time, vehicle=self.vehicle, lights=self._shown, hits=sorted(hits)
        )

    @property
    def time(self) -> float:
        """Simulation time since reset [s]."""
        return self._num_steps * self.config.control_interval

    @property
    def vehicle(self) -> VehicleState:
        """State of the car now."""
        return self.car.state()

    @property
    def action(self) -> Action:
        """The last action taken, clipped."""
        return self._action

    @property
    def lights(self) -> Mapping[str, Signal]:
        """What every light shows now."""
        return signals.all_at(self.town, self.time + self.light_phase)

    @property
    def is_on_lane(self) -> bool:
        """Whether the centre of the car is on a driving lane."""
        return self._rules.on_lane(self.vehicle)

    def observe(self) -> Observation:
        """All that a learned policy may see."""
        vehicle = self.vehicle
        bev = self._projector.project(
            x=vehicle.x, y=vehicle.y, yaw=vehicle.yaw, time=self.time, light_phase=self.light_phase
        )
        state = np.array(
            (vehicle.speed, self._action.acceleration, self._action.steering), np.float32
        )
        bev.flags.writeable = state.flags.writeable = False  # nobody else has them: no need to copy
        return Observation(bev=bev, state=state)

    def save(self) -> Snapshot:
        """Take a snapshot to return to."""
        return Snapshot(self.car.save(), self._num_steps, self.light_phase, self._action)

    def restore(self, snapshot: Snapshot) -> None:
        """Return to a snapshot of a simulation of the same town."""
        self.car.restore(snapshot.physics)
        self._num_steps = snapshot.num_steps
        self.light_phase = snapshot.light_phase
        self._action = snapshot.action
        self._rules.reset()
        self._light_lamps()

    def _light_lamps(self) -> None:
        """Let the lamps of the scene show what the lights show, for whoever renders it."""
        lights = self.lights
        if lights is not self._shown:
            set_lamps(self.model, self.town, lights)
            self._shown = lights
