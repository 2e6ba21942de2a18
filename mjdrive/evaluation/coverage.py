"""How much of a town a drive saw, and how soon: directed lanes visited over distance driven."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Episode, Town
from mjdrive.evaluation.lane_keeping import LaneTrack
from mjdrive.town.lane_graph import onward

WRONG_WAY = 0.5 * math.pi
"""A car more askew to a lane than this does not drive along it [rad]."""


@dataclass(frozen=True, slots=True)
class Coverage:
    """Share of a town's directed lanes that was visited, over the distance driven.

    Attributes:
        distance_km: Where another lane was first visited, rising, with zero in front and the whole distance at the end,
            shape (N,) [km].
        share: Share of the lanes visited by then, shape (N,) [-].
        lanes: Directed lanes outside junctions that can be driven on without end [-].
    """

    distance_km: Float[np.ndarray, " N"]
    share: Float[np.ndarray, " N"]
    lanes: int

    def km_to(self, share: float) -> float | None:
        """Distance until a share [-] of the lanes was visited [km]; None if it never was."""
        reached = np.flatnonzero(self.share >= share - 1e-12)
        return float(self.distance_km[reached[0]]) if len(reached) else None

    def mean_share(self, distance_km: float) -> float:
        """Mean share over the first so many kilometres [-]; who drove less stays at the last share."""
        edges = np.append(np.minimum(self.distance_km, distance_km), distance_km)
        return float(np.sum(np.diff(edges) * self.share) / distance_km)


def reachable_lanes(town: Town) -> tuple[str, ...]:
    """The directed lanes outside junctions from which one can drive on without end; all of them if none leads so far."""
    streets = [name for name, lane in town.lanes.items() if lane.junction is None]
    ahead = onward(town)
    return tuple(name for name in streets if math.isinf(ahead[name])) or tuple(streets)


def first_visits(episode: Episode, lanes: LaneTrack, town: Town) -> dict[str, float]:
    """Tell after which distance a drive first came along each directed lane outside junctions.

    Args:
        episode: The drive.
        lanes: Where it was on the lanes.
        town: Where.

    Returns:
        Distance by the name of the lane, rising [m]; lanes not visited are left out.
    """
    wanted = set(reachable_lanes(town))
    along = distance_along(episode)
    visited: dict[str, float] = {}
    for step in np.flatnonzero(episode.on_lane & (np.abs(lanes.heading_error) < WRONG_WAY)):
        name = lanes.lane[step]
        if name in wanted:
            wanted.remove(name)
            visited[name] = float(along[step])
    return visited


def distance_along(episode: Episode) -> Float[np.ndarray, " T"]:
    """Path length on driving lanes up to each step [m]."""
    steps = np.hypot(*np.diff(episode.vehicle[:, :2], axis=0, prepend=episode.vehicle[:1, :2]).T)
    return np.asarray(np.cumsum(np.where(episode.on_lane, steps, 0.0)))


def coverage(drives: Sequence[tuple[Episode, LaneTrack]], town: Town) -> Coverage:
    """Follow what several drives of one policy visited, one after the other.

    Args:
        drives: Each drive, and where it was on the lanes.
        town: Where.
    """
    visits = [first_visits(episode, lanes, town) for episode, lanes in drives]
    lengths = [float(distance_along(episode)[-1]) for episode, _ in drives]
    return joined_coverage(visits, lengths, num_lanes=len(reachable_lanes(town)))


def joined_coverage(
    visits: Sequence[Mapping[str, float]], lengths: Sequence[float], *, num_lanes: int
) -> Coverage:
    """Join what several drives of one policy visited, one after the other.

    Args:
        visits: Of each drive, what `first_visits` tells.
        lengths: Distance of each drive [m].
        num_lanes: Directed lanes of the town that can be driven on without end [-].
    """
    seen: set[str] = set()
    distances, total = [0.0], 0.0
    for visited, length in zip(visits, lengths, strict=True):
        for name, distance in sorted(visited.items(), key=lambda visit: visit[1]):
            if name not in seen:
                seen.add(name)
                distances.append(total + distance)
        total += length
    shares = np.arange(len(distances)) / num_lanes
    return Coverage(
        distance_km=np.array([*distances, total]) / 1000.0,
        share=np.append(shares, shares[-1]),
        lanes=num_lanes,
    )
