import hashlib
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from mjdrive import geometry
from mjdrive.config import MpcConfig, PidConfig
from mjdrive.datatypes import (
    Action,
    Lane,
    Policy,
    Route,
    Signal,
    Situation,
    Town,
    TrafficLight,
    VehicleState,
)
from mjdrive.errors import SolverError
from mjdrive.evaluation.comfort import jerk_rms, steering_unrest, steering_whiteness
from mjdrive.expert import mpc_solver
from mjdrive.expert.mpc import MpcExpert
from mjdrive.expert.pid import PidExpert
from mjdrive.vehicle.parameters import VehicleParameters

INTERVAL = 0.1
LANE_WIDTH = 4.0
CAR = VehicleParameters.default()
NOSE = CAR.length - CAR.rear_overhang


def line(*, radius: float | None = None) -> np.ndarray:
    """60 m east, and then a left quarter of a circle and 40 m north, or 90 m more east."""
    if radius is None:
        return np.array([[0.0, 0.0], [150.0, 0.0]])
    angle = np.linspace(0.0, np.pi / 2, 60)
    arc = np.array([60.0, radius]) + radius * np.stack([np.sin(angle), -np.cos(angle)], axis=1)
    return np.vstack([[0.0, 0.0], arc, arc[-1] + [0.0, 40.0]])


def town_of(points: np.ndarray, *, stop_at: float | None = None) -> tuple[Town, Route]:
    """A town of one road, with a light at a station of it if asked for."""
    route_points = geometry.resample(points, 1.0)
    station = geometry.stations(route_points)
    split = stop_at if stop_at is not None else 1e9
    lanes = {
        "near": Lane("near", points, LANE_WIDTH, ("far",), None, "light" if stop_at else None),
        "far": Lane("far", points, LANE_WIDTH, (), None, None),
    }
    lights = {}
    if stop_at is not None:
        bar = np.array([[stop_at, 2.0], [stop_at, -2.0]])
        lights["light"] = TrafficLight(
            "light", "near", "j", bar, 0.0, np.zeros(2), ((Signal.GREEN, 10.0),), 0.0
        )
    bounds = np.array([0.0, -50.0, 200.0, 50.0])
    route = Route(
        lanes=("near", "far"),
        points=route_points,
        station=station,
        yaw=geometry.headings(route_points),
        curvature=geometry.curvatures(route_points),
        lane_index=(station > split).astype(int),
    )
    return Town("plain", lanes, lights, bounds, ""), route


class Drive:
    """The car on the proving ground along a route, with a light that the test sets."""

    def __init__(self, ground, route: Route, *, speed: float = 6.0, offset: float = 0.0) -> None:
        self.ground, self.route, self.signal = ground, route, Signal.GREEN
        ground.car.place(0.0, offset, 0.0, speed)
        self.time = 0.0
        self.states: list[VehicleState] = []
        self.actions: list[Action] = []
        self.offsets: list[float] = []

    def situation(self) -> Situation:
        state = self.ground.car.state()
        seen = geometry.project(self.route.points, np.array([state.x, state.y]))
        return Situation(
            time=self.time,
            vehicle=state,
            route=self.route,
            station=seen.station,
            offset=seen.offset,
            lights={"light": self.signal},
        )

    def go(self, expert: Policy[Situation], duration: float) -> "Drive":
        for _ in range(round(duration / INTERVAL)):
            view = self.situation()
            action = expert.act(view)
            self.states.append(view.vehicle)
            self.offsets.append(view.offset)
            self.actions.append(action)
            self.ground.drive(action.acceleration, action.steering, INTERVAL)
            self.time = round(self.time + INTERVAL, 6)
        return self

    @property
    def speeds(self) -> np.ndarray:
        return np.array([state.speed for state in self.states])

    @property
    def steering(self) -> np.ndarray:
        return np.array([action.steering for action in self.actions])


def test_bend_is_driven_within_its_lane_and_more_smoothly_than_by_the_pid(ground):
    town, route = town_of(line(radius=8.0))
    expert = MpcExpert(town)
    planned = Drive(ground, route).go(expert, 19.0)
    assert np.abs(planned.offsets).max() < 0.25
    assert planned.states[-1].y > 20.0, "expected the car to be round the bend"
    assert expert.solves.failed == expert.solves.max_iterations == 0
    reacted = Drive(ground, route).go(PidExpert(town), 19.0)
    for figure in (
        lambda drive: jerk_rms(drive.speeds, interval=INTERVAL),
        lambda drive: steering_unrest(drive.steering, interval=INTERVAL),
    ):
        assert figure(planned) < 0.5 * figure(reacted)
    # Half of the PID's is out of anyone's reach at this speed: scripts/steering_bound.py.
    assert whiteness(planned) < whiteness(reacted)


def whiteness(drive: Drive) -> float:
    return steering_whiteness(drive.steering, interval=INTERVAL)


def test_steady_speed_is_the_one_that_the_law_allows(ground):
    town, route = town_of(line())
    drive = Drive(ground, route, speed=0.0).go(MpcExpert(town), 8.0)
    assert drive.speeds[-1] == pytest.approx(PidConfig().target_speed, abs=0.05)
    assert np.diff(drive.speeds).max() / INTERVAL < 1.2 * MpcConfig().acceleration


@pytest.mark.parametrize("signal", [Signal.RED, Signal.YELLOW])
def test_car_stops_one_gap_before_the_line_holds_there_and_starts_at_green(signal, ground):
    town, route = town_of(line(), stop_at=50.5)
    drive, expert = Drive(ground, route), MpcExpert(town)
    drive.signal = signal
    drive.go(expert, 14.0)
    gap = 50.5 - NOSE - drive.states[-1].x
    assert gap == pytest.approx(PidConfig().stop_gap, abs=0.45)
    assert drive.speeds[-1] == pytest.approx(0.0, abs=0.01)
    assert drive.actions[-1] == Action(acceleration=-1.0, steering=0.0)
    drive.signal = Signal.GREEN
    assert drive.go(expert, 1.0).speeds[-1] > 0.1


def test_yellow_that_comes_too_late_is_passed(ground):
    town, route = town_of(line(), stop_at=50.5)
    drive, expert = Drive(ground, route), MpcExpert(town)
    while 50.5 - NOSE - ground.car.state().x > 2.0:
        drive.go(expert, INTERVAL)
    drive.signal = Signal.YELLOW
    drive.go(expert, 2.0)
    assert drive.speeds.min() > 5.0


@pytest.mark.parametrize("offset", [-1.0, 1.0])
def test_start_beside_the_lane_comes_back_without_swinging(offset, ground):
    town, route = town_of(line())
    drive = Drive(ground, route, speed=5.0, offset=offset).go(MpcExpert(town), 8.0)
    beyond = -np.sign(offset) * np.array(drive.offsets)
    assert beyond.max() < 0.25
    assert np.abs(drive.offsets[-20:]).max() < 0.1


def test_mirrored_road_is_driven_with_mirrored_steering(ground):
    town, route = town_of(line(radius=8.0))
    left = Drive(ground, route).go(MpcExpert(town), 12.0)
    mirrored, other = town_of(line(radius=8.0) * [1.0, -1.0])
    right = Drive(ground, other).go(MpcExpert(mirrored), 12.0)
    np.testing.assert_allclose(right.steering, -left.steering, atol=5e-3)


def test_failed_solve_is_met_by_the_pid_without_a_jump_and_counted(ground):
    town, route = town_of(line(radius=8.0))
    expert = MpcExpert(town, config=MpcConfig(max_iterations=1))
    drive = Drive(ground, route).go(expert, 10.0)
    assert expert.solves.max_iterations + expert.solves.failed == 100
    assert expert.solves.solved == 0
    alone = Drive(ground, route).go(PidExpert(town), 10.0)
    assert drive.actions == alone.actions


@pytest.mark.parametrize("late_plan", ["plan", "pid"])
def test_late_plan_is_counted_and_met_by_the_pid_when_told(late_plan, ground):
    town, route = town_of(line(radius=8.0))
    hurried = MpcExpert(town, config=MpcConfig(late_after=1e-9, late_plan=late_plan))
    late = Drive(ground, route).go(hurried, 10.0)
    assert hurried.solves.late == hurried.solves.solved == 100
    other = {"plan": MpcExpert(town), "pid": PidExpert(town)}[late_plan]
    assert late.actions == Drive(ground, route).go(other, 10.0).actions


def test_handover_to_the_pid_begins_where_the_plan_was():
    town, route = town_of(line())
    expert = MpcExpert(town)
    here = Situation(0.0, VehicleState(20.0, 0.5, 0.0, 5.0, 0.0, 0.0), route, 20.0, 0.5, {})
    later = replace(here, time=INTERVAL)
    planned = expert.act(here)
    pid = PidExpert(town)
    pid.act(here)
    own = pid.act(later).steering
    expert._solver.solve = lambda *_: mpc_solver.Solution(
        mpc_solver.SolveStatus.FAILED, np.zeros(0), np.nan, 0
    )
    taken = expert.act(later).steering
    assert min(planned.steering, own) < taken < max(planned.steering, own)


def test_wheels_turned_by_someone_else_leave_the_decision_to_the_pid(ground):
    town, route = town_of(line())
    drive, expert = Drive(ground, route), MpcExpert(town)
    drive.go(expert, 1.0)
    assert expert.solves.recoveries == 0
    ground.drive(0.0, 0.5, 0.4)
    drive.time += 0.4
    drive.go(expert, 0.5)
    assert expert.solves.recoveries > 0
    drive.go(expert, 6.0)
    assert abs(drive.offsets[-1]) < 0.1


def test_solver_that_casadi_lacks_is_named_and_replaced_only_when_told(monkeypatch):
    town, _ = town_of(line())
    has = mpc_solver.ca.has_nlpsol
    monkeypatch.setattr(mpc_solver.ca, "has_nlpsol", lambda name: name != "fatrop" and has(name))
    with pytest.raises(SolverError, match=r"nlpsol 'fatrop'.*Available here: ipopt"):
        MpcExpert(town)
    told = MpcExpert(town, config=MpcConfig(fallback_solver="ipopt"))
    assert told.solver_name == "ipopt"


def test_unknown_solver_is_refused_with_the_known_ones():
    town, _ = town_of(line())
    with pytest.raises(SolverError, match=r"Unknown solver 'simplex'.*fatrop, ipopt"):
        MpcExpert(town, config=MpcConfig(solver="simplex"))


@pytest.mark.parametrize("solver", ["ipopt", "sqpmethod+qrqp", "sqpmethod+piqp"])
def test_solvers_agree_on_a_plan(solver):
    town, route = town_of(line(radius=8.0))
    state = VehicleState(55.0, 0.2, 0.05, 4.5, 0.0, 0.02)
    here = Situation(0.0, state, route, 55.0, 0.2, {})
    expected = MpcExpert(town).act(here)
    found = MpcExpert(town, config=MpcConfig(solver=solver)).act(here)
    assert found.steering == pytest.approx(expected.steering, abs=2e-3)
    assert found.acceleration == pytest.approx(expected.acceleration, abs=2e-3)


_PLANS = """
import hashlib, sys
sys.path.insert(0, sys.argv[1])
from test_mpc import digest_of_plans
print(digest_of_plans())
"""


def digest_of_plans() -> str:
    """Fifty decisions on a bend, with a made-up car that goes where it looks."""
    town, route = town_of(line(radius=8.0))
    expert = MpcExpert(town)
    actions = []
    for step in range(50):
        station = 50.0 + 0.4 * step
        x, y, yaw = (
            float(np.interp(station, route.station, column))
            for column in (*route.points.T, route.yaw)
        )
        state = VehicleState(x, y, yaw, 4.0, 0.0, 0.02 * np.sin(step))
        actions.append(expert.act(Situation(INTERVAL * step, state, route, station, 0.05, {})))
    values = np.array([(action.acceleration, action.steering) for action in actions])
    return hashlib.sha256(values.tobytes()).hexdigest()


def test_another_process_decides_the_same_bytes(request):
    folder = str(request.path.parent)
    run = [sys.executable, "-c", _PLANS, folder]
    other = subprocess.run(run, capture_output=True, text=True, check=True)
    assert other.stdout.strip() == digest_of_plans()


def test_pid_path_does_not_load_casadi():
    code = "import sys, mjdrive.expert.pid, mjdrive.cli.main; print('casadi' in sys.modules)"
    run = [sys.executable, "-c", code]
    assert subprocess.run(run, capture_output=True, text=True, check=True).stdout.strip() == "False"
