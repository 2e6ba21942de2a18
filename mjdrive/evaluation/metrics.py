"""What a drive is worth: the figures of `summary.json`."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool

from mjdrive import versions
from mjdrive.datatypes import Episode, InfractionKind, Signal, Town
from mjdrive.evaluation import lane_keeping
from mjdrive.evaluation.branches import branches_taken
from mjdrive.evaluation.lane_keeping import LaneKeeping
from mjdrive.evaluation.lights_met import is_before
from mjdrive.town import signals
from mjdrive.vehicle import cars

RED_LIGHT_FACTOR = 0.7
"""What a red light run leaves of the score [-] (Leaderboard 1.0; the paper's only penalty)."""

STANDSTILL_SPEED = 0.1
"""Below this the car stands [m/s] (Leaderboard 1.0)."""

CONTROL_INTERVAL = 0.1
"""Length of a drive of one step [s]; longer drives say it themselves."""


@dataclass(frozen=True, slots=True)
class DriveSummary:
    """The figures of one drive.

    Attributes:
        town: Name of the town.
        car: Name of the car; drives from before one could choose were the default car's.
        policy: Name of the policy that drove.
        seed: Seed of the drive [-].
        steps: Control steps [-].
        duration_s: Simulated time [s].
        distance_m: Path length of the car while it was on driving lanes [m].
        red_lights: Red lights run [-].
        collisions: Collisions with things [-].
        kerb_strikes: Kerbs hit [-].
        road_departures: Times that the car left the road [-].
        wrong_ways: Times that the car drove against its lane [-].
        standstills: Times that the car was stuck for so long that the rules hold it against the drive [-].
        off_road_s: Time off the driving lanes [s].
        stuck_s: Time at a standstill with no red or yellow light to wait for [s].
        score: Distance times 0.7 to the power of the red lights run [m].
        lane_keeping: How far the car was from the centre of its lane while it moved.
        branches_taken: How often each way through a junction was driven, by the name of its lane [-].
        versions: Versions of the software that drove.
    """

    town: str
    car: str
    policy: str
    seed: int
    steps: int
    duration_s: float
    distance_m: float
    red_lights: int
    collisions: int
    kerb_strikes: int
    road_departures: int
    wrong_ways: int
    standstills: int
    off_road_s: float
    stuck_s: float
    score: float
    lane_keeping: LaneKeeping
    branches_taken: Mapping[str, int]
    versions: Mapping[str, str]


def summarise(episode: Episode, town: Town) -> DriveSummary:
    """Measure one drive.

    Args:
        episode: The drive.
        town: The town that it was driven in.

    Returns:
        Its figures; equal episodes give equal figures.
    """
    interval = control_interval(episode)
    counts = Counter(infraction.kind for infraction in episode.infractions)
    distance = distance_on_lanes(episode)
    stuck = stands(episode) & ~waits_at_light(episode, town)
    return DriveSummary(
        town=episode.town,
        car=episode.metadata.get("car", cars.DEFAULT),
        policy=episode.policy,
        seed=episode.seed,
        steps=len(episode.time),
        duration_s=_rounded(len(episode.time) * interval),
        distance_m=_rounded(distance),
        red_lights=counts[InfractionKind.RED_LIGHT],
        collisions=counts[InfractionKind.COLLISION],
        kerb_strikes=counts[InfractionKind.KERB],
        road_departures=counts[InfractionKind.OFF_ROAD],
        wrong_ways=counts[InfractionKind.WRONG_WAY],
        standstills=counts[InfractionKind.STUCK],
        off_road_s=_rounded(np.count_nonzero(~episode.on_lane) * interval),
        stuck_s=_rounded(np.count_nonzero(stuck) * interval),
        score=_rounded(distance * RED_LIGHT_FACTOR ** counts[InfractionKind.RED_LIGHT]),
        lane_keeping=lane_keeping.summarise(episode, lane_keeping.track(episode, town)),
        branches_taken=branches_taken(episode, town),
        versions=versions.from_metadata(episode.metadata),
    )


def control_interval(episode: Episode) -> float:
    """Time between two steps of a drive [s]."""
    if len(episode.time) < 2:
        return CONTROL_INTERVAL
    return float(np.median(np.diff(episode.time)))


def distance_on_lanes(episode: Episode) -> float:
    """Path length between those neighbouring steps that are both on driving lanes [m]."""
    lengths = np.hypot(*np.diff(episode.vehicle[:, :2], axis=0).T)
    return float(np.sum(lengths[episode.on_lane[1:] & episode.on_lane[:-1]]))


def stands(episode: Episode) -> Bool[np.ndarray, " T"]:
    """Whether the car stands, step by step."""
    return np.abs(episode.vehicle[:, 3]) < STANDSTILL_SPEED


def waits_at_light(episode: Episode, town: Town) -> Bool[np.ndarray, " T"]:
    """Whether the car is close before a light that is red or yellow, step by step."""
    waits = np.zeros(len(episode.time), dtype=bool)
    for light in town.lights.values():
        near = np.flatnonzero(is_before(episode.vehicle, light))
        shown = [signals.at(light, float(episode.time[t]) + episode.light_phase) for t in near]
        waits[near] |= np.array(shown, dtype=int) != Signal.GREEN
    return waits


def _rounded(value: float) -> float:
    """Drop the digits below a tenth of a millimetre or millisecond, which carry no meaning."""
    return round(float(value), 4)
