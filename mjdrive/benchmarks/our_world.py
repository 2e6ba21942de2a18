"""Our side beside the rivals: a control step with rules and the bird's-eye view of 192 x 192 x 5, as `serving` steps it."""

from collections.abc import Iterator

import cv2
import numpy as np

from mjdrive.datatypes import Action
from mjdrive.episodes.rollout import rollout
from mjdrive.episodes.views import FollowRoute
from mjdrive.expert.pid import PidExpert
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library, routing
from mjdrive.versions import versions

NUM_STEPS = 900
"""Control steps of the drive; then it starts again [-]."""


class TownDrive:
    """The actions of the PID expert on a route of town02, again and again; the time holds no expert.

    Attributes:
        facts: What is stepped.
        num_resets: Fresh starts so far [-].
        deciding: Nothing, as the actions are known [s].
        simulation: Where it drives.
        actions: What the expert did.
    """

    def __init__(self, route_name: str) -> None:
        town = library.load("town02")
        self._route = routing.route_through(
            town, np.array(library.load_settings(town.name).routes[route_name])
        )
        self.simulation = Simulation(town)
        self.num_resets = 0
        self.deciding = 0.0
        self.start()
        expert = PidExpert(town, parameters=self.simulation.car.parameters)
        follow = FollowRoute(self._route)
        drive = rollout(
            self.simulation,
            expert,
            follow,
            num_steps=NUM_STEPS,
            seed=0,
            stop=lambda: follow.is_finished,
        )
        self.actions = [Action(*row) for row in drive.actions.tolist()]
        shape = self.simulation.observe().bev.shape
        self.facts = {"versions": versions(), "observation": list(shape), "drive": len(drive.time)}
        self._pending: Iterator[Action] = iter(())

    def step(self) -> None:
        """Do one control step with rules and observation; at the end of the drive start again first."""
        action = next(self._pending, None)
        if action is None:
            self.start()
            self.num_resets += 1
            self._pending = iter(self.actions)
            action = next(self._pending)
        self.simulation.step(action)
        self.simulation.observe()

    def start(self) -> None:
        """Put the car back to where the drive begins."""
        x, y = self._route.points[0].tolist()
        self.simulation.place(x=x, y=y, yaw=float(self._route.yaw[0]), seed=0)


def make(argument: str) -> TownDrive:
    """Make our world for `serving`.

    Args:
        argument: Name of a route of town02.
    """
    cv2.setNumThreads(1)
    return TownDrive(argument)
