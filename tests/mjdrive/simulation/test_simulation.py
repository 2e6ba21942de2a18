import mujoco
import numpy as np
import pytest

from mjdrive import geometry
from mjdrive.config import SimulationConfig
from mjdrive.datatypes import Action, InfractionKind
from mjdrive.errors import ConfigError, RouteError
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import signals

GO = Action(acceleration=0.6, steering=0.1)


def longest_lane(simulation: Simulation) -> str:
    lanes = simulation.town.lanes.values()
    streets = [lane for lane in lanes if lane.junction is None]
    return max(streets, key=lambda lane: geometry.stations(lane.centerline)[-1]).id


@pytest.fixture
def driven(simulation: Simulation) -> Simulation:
    simulation.reset(lane=longest_lane(simulation), station=20.0, seed=3)
    return simulation


def test_reset_puts_the_car_at_rest_on_the_centre_of_the_lane(driven):
    lane = driven.town.lanes[longest_lane(driven)]
    vehicle = driven.vehicle
    seen = geometry.project(lane.centerline, np.array([vehicle.x, vehicle.y]))
    assert abs(seen.offset) < 1e-3
    assert seen.station == pytest.approx(20.0, abs=1e-2)
    assert abs(vehicle.speed) < 0.02
    assert driven.time == 0.0


def test_ten_steps_are_one_second(driven):
    for _ in range(10):
        driven.step(GO)
    assert driven.time == pytest.approx(1.0)
    assert driven.data.time == pytest.approx(1.0, abs=1e-6)


def test_state_part_holds_speed_and_the_previous_action_as_it_was_clipped(driven):
    driven.step(Action(acceleration=3.0, steering=-0.25))
    speed, acceleration, steering = driven.observe().state
    assert speed == pytest.approx(driven.vehicle.speed, rel=1e-6)
    assert (acceleration, steering) == (1.0, -0.25)


def test_snapshot_brings_back_the_same_future_bit_by_bit(driven):
    for _ in range(5):
        driven.step(GO)
    snapshot = driven.save()
    first = [driven.step(GO) or driven.vehicle for _ in range(20)]
    driven.restore(snapshot)
    again = [driven.step(GO) or driven.vehicle for _ in range(20)]
    assert first == again


def test_observations_do_not_share_memory(driven):
    first = driven.observe()
    before = first.bev.copy()
    for _ in range(30):
        driven.step(GO)
    second = driven.observe()
    np.testing.assert_array_equal(first.bev, before)
    assert not np.array_equal(first.bev, second.bev)


def test_lights_run_on_from_the_seeds_phase(driven):
    assert driven.light_phase == signals.phase(driven.town, 3)
    assert dict(driven.lights) == signals.all_at(driven.town, driven.light_phase)


def test_lamps_of_the_scene_show_what_the_lights_show(driven):
    changes = 0
    before = dict(driven.lights)
    for _ in range(110):
        for light, shown in driven.lights.items():
            lamp = driven.model.geom(f"lamp_{light}_{shown.name.lower()}").rgba
            assert lamp.max() > 0.9
        driven.step(Action(acceleration=-1.0, steering=0.0))
        changes += dict(driven.lights) != before
        before = dict(driven.lights)
    assert changes >= 1


def test_full_throttle_off_the_street_is_noticed(driven):
    found = []
    for _ in range(150):
        found += driven.step(Action(acceleration=0.7, steering=-0.3))
    kinds = {infraction.kind for infraction in found}
    assert InfractionKind.KERB in kinds
    assert InfractionKind.OFF_ROAD in kinds
    assert not driven.is_on_lane
    assert all(np.isfinite(driven.data.qpos))


def test_nothing_is_hit_where_the_car_says_that_it_is_clear(driven):
    clear = []

    def look() -> None:
        clear.append(driven.car.is_clear)
        assert not (clear[-1] and driven._contacts.hits())

    found = []
    for _ in range(150):
        found += driven.step(Action(acceleration=0.7, steering=-0.3), on_motion=look)
    assert {True, False} == set(clear)
    assert InfractionKind.KERB in {infraction.kind for infraction in found}


def test_no_warning_and_no_log_file_after_a_crash(driven, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for _ in range(100):
        driven.step(Action(acceleration=1.0, steering=-1.0))
    assert list(tmp_path.iterdir()) == []
    assert driven.data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number == 0


def test_unknown_lane_and_station_off_the_lane_are_refused(driven):
    with pytest.raises(RouteError, match="has no lane 'nowhere'"):
        driven.reset(lane="nowhere", station=0.0, seed=0)
    with pytest.raises(RouteError, match="is not on lane"):
        driven.reset(lane=longest_lane(driven), station=1e4, seed=0)


def test_start_inside_something_solid_is_refused_by_its_name(simulation):
    for kind in ("building", "pole"):
        geoms = [simulation.model.geom(index) for index in range(simulation.model.ngeom)]
        solid = next(it for it in geoms if it.name.startswith(kind) and it.contype)
        x, y, _ = simulation.data.geom(solid.name).xpos
        with pytest.raises(
            RouteError, match=rf"cannot start at \(.*\) in town02: {kind}.*stands there"
        ):
            simulation.place(x=float(x), y=float(y), yaw=0.0, seed=0)


def test_intervals_that_do_not_divide_are_refused():
    with pytest.raises(ConfigError, match=r"car_update_interval is 0.03 s"):
        SimulationConfig(car_update_interval=0.03)
