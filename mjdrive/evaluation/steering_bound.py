"""How smoothly a route can be steered at all: the least steering whiteness that a lane error leaves room for.

The steering of a whole route is optimised at once, at the PID's own speeds or a share of them and with the model of the
car that the MPC plans with. Such an optimum knows all of the route, has no rack to wait for and no disturbance to
meet, so nobody who drives at these speeds steers more smoothly.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca
import numpy as np
from jaxtyping import Float

from mjdrive import geometry
from mjdrive.config import CollectConfig
from mjdrive.datatypes import Episode, Route
from mjdrive.episodes.collection import collect_route
from mjdrive.episodes.plan import lay_routes
from mjdrive.evaluation.comfort import comfort
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from mjdrive.vehicle.bicycle import Bicycle, Trigonometry
from mjdrive.vehicle.parameters import VehicleParameters

SPACING = 0.25
"""Between two points of the steering that is optimised [m]."""

MOVING = 0.5
"""Standing cars steer nothing and are off nothing; slower than this counts as standing [m/s]."""

NARROWEST_LANE = 4.0
"""Lanes of the shipped towns [m]."""


@dataclass(frozen=True)
class Least:
    """What can be reached at a share of the PID's speeds.

    Attributes:
        pace: That share, while the car moves [-].
        duration: How long the route then takes, standing at lights included [s].
        allowance: RMS lane error allowed [m].
        whiteness: Smallest RMS rate of the steering command that was found [1/s].
        other_start: The larger answer of the two starts [1/s].
    """

    pace: float
    duration: float
    allowance: float
    whiteness: float
    other_start: float


@dataclass(frozen=True)
class Bound:
    """A route, the PID on it under light seed 0, and what can be reached there.

    Attributes:
        route: Town and route.
        whiteness: RMS rate of the PID's steering command [1/s].
        lane_error: Its RMS distance from the route while it moves [m].
        least: The least, for each pace and allowance.
    """

    route: str
    whiteness: float
    lane_error: float
    least: tuple[Least, ...]


@dataclass(frozen=True)
class Bounds:
    """Bounds of routes, and the code that they were found with.

    Attributes:
        code: SHA-256 of the sources, hexadecimal.
        versions: Of the packages that do the work.
        bounds: A route each.
    """

    code: str
    versions: dict[str, str]
    bounds: tuple[Bound, ...] = ()


def drive(simulation: Simulation, route: Route) -> Episode:
    """Let the PID drive a route once, undisturbed, under light seed 0."""
    return collect_route(simulation, route, config=CollectConfig(disturbance=None), seed=0)


def along(
    route: Route, episode: Episode
) -> tuple[Float[np.ndarray, " T"], Float[np.ndarray, " T"]]:
    """Station and offset of the rear axle at each step [m]."""
    station, offset, last = [], [], 0.0
    for x, y in episode.vehicle[:, :2]:
        near = slice(*np.searchsorted(route.station, [last - 3.0, last + 15.0]))
        seen = geometry.project(route.points[near], np.array([x, y]))
        last = float(route.station[near][0] + seen.station)
        station.append(last)
        offset.append(seen.offset)
    return np.array(station), np.array(offset)


def least_whiteness(
    route: Route,
    station: Float[np.ndarray, " T"],
    speed: Float[np.ndarray, " T"],
    *,
    car: VehicleParameters,
    allowance: float,
    interval: float,
    pace: float,
) -> Least:
    """Smallest RMS rate of the steering command along a route.

    Args:
        route: What is followed.
        station: Where a drive was at each step [m].
        speed: Its speed there [m/s].
        car: Which car.
        allowance: RMS distance from the route that it may have while it moves [m].
        interval: Time between two steps [s].
        pace: Factor on the speeds while it moves [-].

    Returns:
        The rate over the whole time of the drive, standstill included.
    """
    moving = speed > MOVING
    grid = np.arange(station[0], station[-1], SPACING)
    num = len(grid)
    speeds = ca.DM(pace * np.interp(grid, station[moving], speed[moving]))
    curvature = ca.DM(np.interp(grid, route.station, route.curvature))
    offset, heading, angle = (ca.MX.sym(name, num) for name in ("offset", "heading", "angle"))
    maths = Trigonometry(ca.sin, ca.cos, ca.tan)
    bicycle = Bicycle.of(car)

    def between(values: ca.MX | ca.DM) -> ca.MX | ca.DM:
        return (values[:-1] + values[1:]) / 2

    n, mu, v, kappa = between(offset), between(heading), between(speeds), between(curvature)
    path_curvature = bicycle.path_curvature(between(angle), v, maths)
    course = mu - bicycle.rear_compliance * v**2 * path_curvature
    stretch = (1 - n * kappa) / ca.cos(course)
    closed = ca.vertcat(
        ca.diff(offset) - SPACING * stretch * ca.sin(course),
        ca.diff(heading) - SPACING * (stretch * path_curvature - kappa),
    )
    lock = car.max_steering_angle
    duration = interval * (np.count_nonzero(~moving) + np.count_nonzero(moving) / pace)
    rate = ca.diff(angle) / SPACING * v / lock
    squares = ca.sum1(rate**2 * SPACING / v) / duration
    mean_square = ca.sum1(offset**2 / speeds) / ca.sum1(1 / speeds)
    edge = 0.5 * NARROWEST_LANE - 0.5 * car.width
    solver = ca.nlpsol(
        "bound",
        "ipopt",
        {
            "x": ca.vertcat(offset, heading, angle),
            "f": squares,
            "g": ca.vertcat(closed, mean_square),
        },
        {"ipopt.print_level": 0, "ipopt.sb": "yes", "print_time": False, "error_on_fail": True},
    )
    limit = np.concatenate([np.full(num, edge), np.full(num, 1.0), np.full(num, lock)])
    zeros = np.zeros(2 * (num - 1))
    bends = np.arctan(car.wheelbase * np.asarray(curvature)[:, 0])
    answers = []
    for wheel in (bends, np.zeros(num)):
        found: Mapping[str, ca.DM] = solver(
            x0=np.concatenate([np.zeros(2 * num), wheel]),
            lbx=-limit,
            ubx=limit,
            lbg=np.append(zeros, 0.0),
            ubg=np.append(zeros, allowance**2),
        )
        answers.append(round(float(np.sqrt(float(found["f"]))), 5))
    return Least(pace, round(float(duration), 1), round(allowance, 4), min(answers), max(answers))


def bound_of(name: str, *, allowance: float, paces: tuple[float, ...]) -> Bound:
    """Drive a route and find out how smoothly it could have been steered."""
    town, _, route_name = name.partition("/")
    simulation = Simulation(library.load(town))
    waypoints = library.load_settings(town).routes
    route = lay_routes(simulation.town, waypoints, settings=CollectConfig())[route_name]
    interval = simulation.config.control_interval
    episode = drive(simulation, route)
    station, offset = along(route, episode)
    speed = episode.vehicle[:, 3]
    error = float(np.sqrt(np.mean(offset[speed > MOVING] ** 2)))
    return Bound(
        route=name,
        whiteness=round(comfort(episode, interval=interval).steering_whiteness, 5),
        lane_error=round(error, 4),
        least=tuple(
            least_whiteness(
                route,
                station,
                speed,
                car=simulation.car.parameters,
                allowance=room,
                interval=interval,
                pace=pace,
            )
            for pace in paces
            for room in (error, allowance)
        ),
    )
