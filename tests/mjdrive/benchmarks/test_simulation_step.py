import numpy as np

from mjdrive.benchmarks import our_world
from mjdrive.benchmarks.simulation_step import physics_seconds


def test_physics_alone_moves_the_car_as_whole_steps_do(monkeypatch) -> None:
    monkeypatch.setattr(our_world, "NUM_STEPS", 20)
    drive = our_world.TownDrive("route1")
    drive.start()
    for action in drive.actions:
        drive.simulation.step(action)
    stepped = drive.simulation.save().physics
    drive.start()
    assert min(physics_seconds(drive.simulation, drive.actions)) > 0.0
    np.testing.assert_array_equal(drive.simulation.car.save(), stepped)


def test_drive_starts_again_at_its_end(monkeypatch) -> None:
    monkeypatch.setattr(our_world, "NUM_STEPS", 5)
    drive = our_world.make("route1")
    for _ in range(11):
        drive.step()
    assert drive.num_resets == 3
    assert drive.simulation.time == 0.1
    assert drive.facts["observation"] == [5, 192, 192]
