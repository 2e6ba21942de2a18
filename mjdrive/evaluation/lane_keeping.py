"""How well a drive keeps its lane, in Frenet coordinates of the nearest lane.

Reference:
    Werling et al., Optimal Trajectory Generation for Dynamic Street Scenarios in a Frenet Frame, ICRA 2010.
"""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from mjdrive.datatypes import Episode, Town
from mjdrive.geometry import wrap_angle
from mjdrive.town.lane_index import LaneIndex, LanePlace

METRES_PER_RADIAN = 1.0
"""How far a lane may lie further off when its heading fits better by one radian [m/rad], as in `routing`."""

MOVING_SPEED = 0.1
"""A car slower than this stands, and keeping the lane is no merit [m/s] (Leaderboard 1.0)."""


@dataclass(frozen=True, slots=True, eq=False)
class LaneTrack:
    """Where the rear axle was on the lane that fitted best, step by step.

    Attributes:
        lane: Name of the lane; empty where none was near.
        station: Arc length along its centre line, shape (T,) [m]; NaN where no lane was near.
        offset: Signed distance from its centre line, positive to the left, shape (T,) [m]; NaN likewise.
        heading_error: Heading of the car against the lane, positive to the left, in (-pi, pi], shape (T,) [rad];
            NaN likewise.
        in_junction: Whether the lane crosses a junction, shape (T,).
    """

    lane: tuple[str, ...]
    station: Float[np.ndarray, " T"]
    offset: Float[np.ndarray, " T"]
    heading_error: Float[np.ndarray, " T"]
    in_junction: Bool[np.ndarray, " T"]


@dataclass(frozen=True, slots=True)
class LaneKeeping:
    """The figures of a drive on its lanes, over the steps at which the car moved; None where there were none.

    Attributes:
        offset_mean_m: Mean distance from the centre line outside junctions [m].
        offset_rms_m: Root mean square of the same [m].
        offset_p95_m: 95 % of these distances are smaller [m].
        junction_offset_mean_m: Mean distance from the nearest way through the junction, inside junctions [m].
        heading_error_rms_rad: Root mean square of the heading against the lane, outside junctions [rad].
    """

    offset_mean_m: float | None
    offset_rms_m: float | None
    offset_p95_m: float | None
    junction_offset_mean_m: float | None
    heading_error_rms_rad: float | None


def track(episode: Episode, town: Town) -> LaneTrack:
    """Follow a drive along the lanes.

    The lane that fits best is the one with the least distance plus 1 m for each radian that its direction is off, so
    that lanes which overlap, and the two directions of a street, are told apart. In a junction nobody knows which way
    the car means to go: of the junction's lanes that run with the car (within a right angle), the nearest counts.

    Args:
        episode: The drive.
        town: The town that it was driven in.

    Returns:
        Frenet coordinates of every step.
    """
    index = LaneIndex(town)
    places = [_place(index, town, *row) for row in episode.vehicle[:, :3].tolist()]
    names = tuple("" if place is None else place.lane for place in places)
    errors = [
        math.nan if place is None else wrap_angle(yaw - place.yaw)
        for place, yaw in zip(places, episode.vehicle[:, 2].tolist(), strict=True)
    ]
    return LaneTrack(
        lane=names,
        station=np.array([math.nan if it is None else it.station for it in places], float),
        offset=np.array([math.nan if it is None else it.offset for it in places], float),
        heading_error=np.array(errors, float),
        in_junction=np.array([_is_in_junction(town, name) for name in names], bool),
    )


def summarise(episode: Episode, lanes: LaneTrack) -> LaneKeeping:
    """Measure how well a drive kept its lane.

    Steps count while the car moves and is on the road: standing at a light says nothing about steering, and time off the
    road is a figure of its own.

    Args:
        episode: The drive.
        lanes: The same drive on the lanes.
    """
    moves = np.abs(episode.vehicle[:, 3]) >= MOVING_SPEED
    counts = moves & episode.on_lane & np.isfinite(lanes.offset)
    street = np.abs(lanes.offset[counts & ~lanes.in_junction])
    junction = np.abs(lanes.offset[counts & lanes.in_junction])
    heading_error = lanes.heading_error[counts & ~lanes.in_junction]
    return LaneKeeping(
        offset_mean_m=_rounded(np.mean(street)) if len(street) else None,
        offset_rms_m=_rounded(np.sqrt(np.mean(street**2))) if len(street) else None,
        offset_p95_m=_rounded(np.percentile(street, 95)) if len(street) else None,
        junction_offset_mean_m=_rounded(np.mean(junction)) if len(junction) else None,
        heading_error_rms_rad=_rounded(np.sqrt(np.mean(heading_error**2)))
        if len(heading_error)
        else None,
    )


def _place(index: LaneIndex, town: Town, x: float, y: float, yaw: float) -> LanePlace | None:
    """The place on the lane that fits best; in a junction, on its nearest lane that runs with the car."""
    near = index.near(x, y)
    if not near:
        return None
    best = min(near, key=lambda place: _misfit(place, yaw))
    junction = town.lanes[best.lane].junction
    if junction is None:
        return best
    ways = [
        place
        for place in near
        if town.lanes[place.lane].junction == junction and math.cos(yaw - place.yaw) >= 0.0
    ]
    return min(ways, key=lambda place: abs(place.offset), default=best)


def _misfit(place: LanePlace, yaw: float) -> float:
    """Distance from the lane, and what its direction is off [m]."""
    return abs(place.offset) + METRES_PER_RADIAN * abs(wrap_angle(yaw - place.yaw))


def _is_in_junction(town: Town, lane: str) -> bool:
    return lane != "" and town.lanes[lane].junction is not None


def _rounded(value: float | np.floating) -> float:
    """Drop the digits below a tenth of a millimetre, which carry no meaning."""
    return round(float(value), 4)
