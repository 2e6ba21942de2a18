import mujoco
import pytest

from mjdrive.datatypes import Action
from mjdrive.vehicle.assembly import car_on_road
from mjdrive.vehicle.car import Car

UPDATE_INTERVAL = 0.02
STEPS_PER_UPDATE = 4


class ProvingGround:
    """The car alone on the plane, under the commands of an expert."""

    def __init__(self) -> None:
        timestep = UPDATE_INTERVAL / STEPS_PER_UPDATE
        self.model = car_on_road(timestep=timestep).compile()
        self.data = mujoco.MjData(self.model)
        self.car = Car(self.model, self.data)

    def drive(self, acceleration: float, steering: float, duration: float) -> None:
        self.car.command(Action(acceleration, steering))
        for _ in range(round(duration / UPDATE_INTERVAL)):
            self.car.update()
            mujoco.mj_step(self.model, self.data, STEPS_PER_UPDATE)


@pytest.fixture
def ground() -> ProvingGround:
    return ProvingGround()
