"""Time the solvers of the MPC expert on the same situations, recorded while it drives a route.

Every solver gets the same problems with the same first guesses, round by round in turn, so that other work on the machine
falls on all of them alike. Its time of a problem is the best of the rounds, in CPU time of one thread.
"""

import argparse
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from mjdrive.config import MpcConfig
from mjdrive.episodes.rollout import rollout
from mjdrive.episodes.views import FollowRoute
from mjdrive.expert.mpc import MpcExpert
from mjdrive.expert.mpc_problem import MpcProblem
from mjdrive.expert.mpc_solver import SOLVERS, MpcSolver, Solution, SolveStatus, is_available
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library, routing
from mjdrive.vehicle.parameters import VehicleParameters

INTERVAL = 0.1


def record(town_name: str, route_name: str, *, every: int, num_steps: int) -> list[tuple[Any, ...]]:
    """Drive a route and keep every n-th problem: guess, parameters and bounds."""
    town = library.load(town_name)
    waypoints = np.array(library.load_settings(town_name).routes[route_name])
    follow = FollowRoute(routing.route_through(town, waypoints))
    simulation = Simulation(town)
    start, yaw = follow.route.points[0], float(follow.route.yaw[0])
    simulation.place(x=float(start[0]), y=float(start[1]), yaw=yaw, seed=0)
    expert = MpcExpert(town, parameters=simulation.car.parameters, control_interval=INTERVAL)
    problems: list[tuple[Any, ...]] = []
    solve = expert._solver.solve  # the script looks over its shoulder

    def keep(*instance: Any) -> Solution:
        problems.append(instance)
        return solve(*instance)

    expert._solver.solve = keep  # type: ignore[method-assign]
    rollout(
        simulation,
        expert,
        follow,
        num_steps=num_steps,
        seed=0,
        stop=lambda: follow.is_finished,
    )
    return problems[::every]


def report(
    name: str, rounds: list[list[Solution]], times: np.ndarray, write: Callable[..., None]
) -> None:
    """Write one row of the table."""
    solutions = rounds[0]
    solved = [it for it in solutions if it.status is SolveStatus.SOLVED]
    share = len(solved) / len(solutions)
    best = 1e3 * times.min(axis=0)
    cost = np.mean([it.cost for it in solved]) if solved else np.nan
    iterations = np.median([it.iterations for it in solutions])
    write(
        f"{name:18s} {np.median(best):8.2f} {np.percentile(best, 99):8.2f} {100 * share:8.1f} "
        f"{cost:10.4f} {iterations:6.0f}"
    )


def main() -> None:
    """Record, time and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--town", default="town02")
    parser.add_argument("--route", default="route1")
    parser.add_argument("--steps", type=int, default=1500, help="control steps to record")
    parser.add_argument("--every", type=int, default=15, help="keep every n-th problem")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--cold", action="store_true", help="begin at zero, not at the last plan")
    arguments = parser.parse_args()
    problems = record(
        arguments.town, arguments.route, every=arguments.every, num_steps=arguments.steps
    )
    if arguments.cold:
        problems = [(np.zeros_like(guess), *rest) for guess, *rest in problems]
    config = MpcConfig()
    car = VehicleParameters.default()
    problem = MpcProblem(config, car, interval=INTERVAL)
    names = [name for name in SOLVERS if is_available(name)]
    solvers = {name: MpcSolver(problem, replace(config, solver=name)) for name in names}
    solutions: dict[str, list[list[Solution]]] = {name: [] for name in names}
    for _ in range(arguments.rounds):
        for name, solver in solvers.items():
            solutions[name].append([solver.solve(*instance) for instance in problems])
    print(
        f"{len(problems)} problems of {arguments.town} {arguments.route}, best of {arguments.rounds} rounds"
    )
    print(
        f"{'solver':18s} {'p50 ms':>8s} {'p99 ms':>8s} {'found %':>8s} {'mean cost':>10s} {'iter.':>6s}"
    )
    for name in names:
        times = np.array(solvers[name].counts.times).reshape(arguments.rounds, -1)
        report(name, solutions[name], times, print)


if __name__ == "__main__":
    main()
