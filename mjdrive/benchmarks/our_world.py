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
    """

    def __init__(self, route_name: str) -> None:
        town = library.load("town02")
        self._route = routing.route_through(
            town, np.array(library.load_settings(town.name).routes[route_name])
        )
        self._simulation = Simulation(town)
        self.num_resets = 0
        self._start()
        expert = PidExpert(town, parameters=self._simulation.car.parameters)
        follow = FollowRoute(self._route)
        drive = rollout(
            self._simulation,
            expert,
            follow,
            num_steps=NUM_STEPS,
            seed=0,
            stop=lambda: follow.is_finished,
        )
        self._actions = [Action(*row) for row in drive.actions.tolist()]
        shape = self._simulation.observe().bev.shape
        self.facts = {"versions": versions(), "observation": list(shape), "drive": len(drive.time)}
        self._pending: Iterator[Action] = iter(())

    def step(self) -> None:
        """Do one control step with rules and observation; at the end of the drive start again first."""
        action = next(self._pending, None)
        if action is None:
            self._start()
            self.num_resets += 1
            self._pending = iter(self._actions)
            action = next(self._pending)
        self._simulation.step(action)
        self._simulation.observe()

    def _start(self) -> None:
        x, y = self._route.points[0].tolist()
        self._simulation.place(x=x, y=y, yaw=float(self._route.yaw[0]), seed=0)


def make(argument: str) -> TownDrive:
    """Make our world for `serving`.

    Args:
        argument: Name of a route of town02.
    """
    cv2.setNumThreads(1)
    return TownDrive(argument)
