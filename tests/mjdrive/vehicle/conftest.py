from collections.abc import Callable
from pathlib import Path

import mujoco
import pytest

from mjdrive.datatypes import Action
from mjdrive.vehicle.assembly import car_on_road, car_path
from mjdrive.vehicle.car import Car

UPDATE_INTERVAL = 0.02
STEPS_PER_UPDATE = 4


class ProvingGround:
    """The car alone on the plane, with something to hold its speed."""

    def __init__(self, car: Path | None = None) -> None:
        timestep = UPDATE_INTERVAL / STEPS_PER_UPDATE
        self.model = car_on_road(timestep=timestep, car=car).compile()
        self.data = mujoco.MjData(self.model)
        self.car = Car(self.model, self.data)
        self.car.place(0.0, 0.0, 0.0)

    def tick(self) -> None:
        self.car.update()
        mujoco.mj_step(self.model, self.data, STEPS_PER_UPDATE)

    def drive(self, acceleration: float, steering: float, duration: float) -> None:
        self.car.command(Action(acceleration, steering))
        for _ in range(round(duration / UPDATE_INTERVAL)):
            self.tick()

    def cruise(self, speed: float, steering: float, duration: float) -> None:
        for _ in range(round(duration / UPDATE_INTERVAL)):
            error = speed - self.car.state().speed
            self.car.command(Action(2.0 * error, steering))
            self.tick()


@pytest.fixture
def ground() -> ProvingGround:
    return ProvingGround()


@pytest.fixture
def my_car(tmp_path: Path) -> Callable[..., Path]:
    """Writes a car file of one's own: car.xml with some of its text changed."""

    def write(*changes: tuple[str, str]) -> Path:
        text = car_path().read_text()
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "my_car.xml"
        path.write_text(text)
        return path

    return write
