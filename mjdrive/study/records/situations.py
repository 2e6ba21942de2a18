"""Where to look at what a policy thinks: where the ways part at a junction, on both of them, and at its red light.

The paper shows three such situations of its own choice. Here they follow from the map alone, so every policy of a study,
and of every study in the same town, is asked the same questions.
"""

import math
from dataclasses import dataclass

import numpy as np

from mjdrive import geometry
from mjdrive.bev.projector import BevProjector
from mjdrive.datatypes import Lane, Move, Observation, Signal, Town
from mjdrive.errors import RouteError
from mjdrive.evaluation.choices import Approach, approaches
from mjdrive.town import signals
from mjdrive.town.lane_graph import lane_length
from mjdrive.vehicle.parameters import VehicleParameters

INTO_JUNCTION = 4.0
"""How far the rear axle is along a way through the junction [m]: the car has begun to turn."""

SHORT_OF_LIGHT = 4.4
"""Distance of the rear axle from the end of the approach at the red light [m]: where the expert waits."""

APPROACH_SPEED, TURNING_SPEED = 5.5, 4.5
"""Of the expert before a junction that it does not have to wait at, and in its turns [m/s]."""

SHOWN_FOR = 3.0
"""A light has shown its colour for so long [s]: longer than the light history reaches back."""

_CLOCK = 60.0  # since reset, so that the light history is full [s]
_SAMPLED = 0.5  # lights are looked at so often [s]


@dataclass(frozen=True, slots=True)
class Moment:
    """A place and a time in a town, and how the car moves there.

    Attributes:
        name: "fork", "left", "straight", "right" or "red".
        title: The same for people.
        approach: Name of the lane that leads into the junction.
        x: Rear-axle centre, world frame [m].
        y: Rear-axle centre, world frame [m].
        yaw: Heading [rad].
        speed: Of the car [m/s].
        acceleration: Previous command [-].
        steering: Previous command, positive to the left [-].
        light_phase: Time into the light cycle at reset, a minute before [s].
    """

    name: str
    title: str
    approach: str
    x: float
    y: float
    yaw: float
    speed: float
    acceleration: float
    steering: float
    light_phase: float

    def observe(self, projector: BevProjector) -> Observation:
        """What a policy sees here."""
        bev = projector.project(
            x=self.x, y=self.y, yaw=self.yaw, time=_CLOCK, light_phase=self.light_phase
        )
        state = np.array((self.speed, self.acceleration, self.steering), np.float32)
        return Observation(bev=bev, state=state)


def situations(town: Town) -> tuple[Moment, ...]:
    """Find moments at one junction: where two ways part, a few metres into each of them, and waiting at its light.

    Taken is the approach with two exits that lies nearest to the middle of the town; one with a light and a choice
    between left and right goes before others.

    Args:
        town: Where.

    Returns:
        "fork", then the two ways from left to right, then "red" where the approach has a light.

    Raises:
        RouteError: If no junction of the town leaves a choice of two.
    """
    fork = _fork(town)
    lane = town.lanes[fork.lane]
    green = _phase(town, lane, Signal.GREEN)
    exits = sorted((town.lanes[name] for name in fork.exits), key=lambda way: way.move)
    return (
        _moment(("fork", "where the ways part"), lane, lane, lane_length(lane), phase=green),
        *(_moment(_words(way.move), lane, way, INTO_JUNCTION, phase=green) for way in exits),
        *_at_red(town, lane),
    )


def _fork(town: Town) -> Approach:
    forks = [it for it in approaches(town) if len(it.exits) == 2]
    if not forks:
        raise RouteError(
            f"Town '{town.name}' has no junction with two ways on from one lane. Expected one, to look at what a policy "
            f"makes of a choice; study a town with T-junctions, such as town02."
        )
    middle = (town.bounds[:2] + town.bounds[2:]) / 2

    def rank(fork: Approach) -> tuple[bool, bool, float]:
        lane = town.lanes[fork.lane]
        moves = {town.lanes[name].move for name in fork.exits}
        distance = float(np.hypot(*(lane.centerline[-1] - middle)))
        return lane.light is None, moves != {Move.LEFT, Move.RIGHT}, distance

    return min(forks, key=rank)


def _words(move: Move) -> tuple[str, str]:
    """Name and title of the moment on a way through the junction."""
    side = move.name.lower()
    return side, "going straight on" if move is Move.STRAIGHT else f"turning {side}"


def _at_red(town: Town, lane: Lane) -> tuple[Moment, ...]:
    if lane.light is None or Signal.RED not in dict(town.lights[lane.light].program):
        return ()
    phase = _phase(town, lane, Signal.RED)
    station = lane_length(lane) - SHORT_OF_LIGHT
    return (_moment(("red", "red light"), lane, lane, station, phase=phase),)


def _moment(
    words: tuple[str, str], approach: Lane, lane: Lane, station: float, *, phase: float
) -> Moment:
    """Put the car on a lane, at most at its end."""
    along = geometry.stations(lane.centerline)
    x, y = (float(np.interp(station, along, lane.centerline[:, axis])) for axis in (0, 1))
    yaw = np.interp(station, along, np.unwrap(geometry.headings(lane.centerline)))
    curvature = np.interp(station, along, geometry.curvatures(lane.centerline))
    parameters = VehicleParameters.default()
    steering = math.atan(parameters.wheelbase * curvature) / parameters.max_steering_angle
    name, title = words
    waits = name == "red"
    return Moment(
        name=name,
        title=title,
        approach=approach.id,
        x=x,
        y=y,
        yaw=geometry.wrap_angle(float(yaw)),
        speed=0.0 if waits else APPROACH_SPEED if lane is approach else TURNING_SPEED,
        acceleration=-1.0 if waits else 0.0,
        steering=0.0 if waits else float(np.clip(steering, -1.0, 1.0)),
        light_phase=phase,
    )


def _phase(town: Town, lane: Lane, wanted: Signal) -> float:
    """The first time into the light cycle at which the light of a lane has shown a colour for long enough [s]."""
    if lane.light is None:
        return 0.0
    light = town.lights[lane.light]
    before = _CLOCK - np.arange(0.0, SHOWN_FOR + _SAMPLED, _SAMPLED)

    def shown(phase: float) -> int:
        return sum(signals.at(light, phase + float(time)) == wanted for time in before)

    return max(np.arange(0.0, signals.duration(light), _SAMPLED).tolist(), key=shown)
