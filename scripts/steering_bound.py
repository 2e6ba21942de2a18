"""How smoothly a route can be steered at all: the least steering whiteness that a lane error leaves room for.

An expert drives the route. Then the steering of the whole route is optimised at once, at the expert's own speeds and with
the model of the car that the MPC plans with: the smallest RMS rate of the command for which the car stays on its
lane and the RMS distance of its rear axle from the route stays within an allowance. It knows all of the route, has no
rack to wait for and no disturbance to meet, so nobody who drives at these speeds steers more smoothly. Who drives more
slowly can: --pace 0.7 asks for the bound at 0.7 of the speeds.

Example: python scripts/steering_bound.py --route town01/route0 --route town02/route0
"""

from collections.abc import Mapping

import casadi as ca
import click
import numpy as np
from jaxtyping import Float

from mjdrive import geometry
from mjdrive.cli.console import progress_bars
from mjdrive.config import CollectConfig
from mjdrive.datatypes import Episode, Route
from mjdrive.episodes.collection import collect_route, expert_of
from mjdrive.episodes.plan import lay_routes
from mjdrive.evaluation.comfort import comfort
from mjdrive.expert import experts
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


def drive(simulation: Simulation, route: Route, *, expert: str) -> Episode:
    """Drive a route once, undisturbed, under light seed 0."""
    settings = CollectConfig(disturbance=None, expert=experts.known(expert))
    return collect_route(
        simulation, route, config=settings, seed=0, expert=expert_of(settings, simulation)
    )


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
) -> float:
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
        The rate over the whole time of the drive, standstill included [1/s].
    """
    moving = speed > MOVING
    grid = np.arange(station[0], station[-1], SPACING)
    num = len(grid)
    speeds = ca.DM(pace * np.interp(grid, station[moving], speed[moving]))
    curvature = ca.DM(np.interp(grid, route.station, route.curvature))
    offset, heading, angle = (ca.MX.sym(name, num) for name in ("offset", "heading", "angle"))
    maths = Trigonometry(ca.sin, ca.cos, ca.tan)
    bicycle = Bicycle.of(car)

    def between(values: ca.MX) -> ca.MX:
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
    found: Mapping[str, ca.DM] = solver(
        x0=np.concatenate(
            [np.zeros(2 * num), np.arctan(car.wheelbase * np.asarray(curvature)[:, 0])]
        ),
        lbx=-limit,
        ubx=limit,
        lbg=np.append(zeros, 0.0),
        ubg=np.append(zeros, allowance**2),
    )
    return float(np.sqrt(float(found["f"])))


@click.command()
@click.option("--route", "routes", multiple=True, default=("town01/route0",), show_default=True)
@click.option("--allowance", default=0.25, show_default=True, help="RMS lane error allowed [m].")
@click.option("--pace", default=1.0, show_default=True, help="Factor on the PID's speeds [-].")
def main(*, routes: tuple[str, ...], allowance: float, pace: float) -> None:
    """Print whiteness and lane error of both experts beside the least whiteness at the speeds of the PID."""
    rows = []
    with progress_bars() as bars:
        task = bars.add_task("routes", total=len(routes), unit="routes")
        for name in routes:
            town, _, route_name = name.partition("/")
            rows.append(row(town, route_name, allowance=allowance, pace=pace))
            bars.advance(task)
    print("| route | PID [1/s] | MPC [1/s] | ", end="")
    print(f"least at the PID's lane error | least at {allowance:g} m | half of the PID's |")
    print(f"|{'---|' * 6}")
    print("\n".join(rows))


def row(town: str, route_name: str, *, allowance: float, pace: float) -> str:
    """One line of the table, in Markdown."""
    simulation = Simulation(library.load(town))
    waypoints = library.load_settings(town).routes
    route = lay_routes(simulation.town, waypoints, settings=CollectConfig())[route_name]
    interval = simulation.config.control_interval
    cells = [f"{town} {route_name}"]
    for expert in ("pid", "mpc"):
        episode = drive(simulation, route, expert=expert)
        station, offset = along(route, episode)
        speed = episode.vehicle[:, 3]
        error = float(np.sqrt(np.mean(offset[speed > MOVING] ** 2)))
        whiteness = comfort(episode, interval=interval).steering_whiteness
        cells.append(f"{whiteness:.3f} ({error:.2f} m)")
        if expert == "pid":
            half = 0.5 * whiteness
            least = [
                least_whiteness(
                    route,
                    station,
                    speed,
                    car=simulation.car.parameters,
                    allowance=room,
                    interval=interval,
                    pace=pace,
                )
                for room in (error, allowance)
            ]
    cells += [f"{value:.3f}" for value in (*least, half)]
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    main()
