"""How much of a town a drive saw, and how soon: directed lanes visited over distance driven."""

import math
from collections.abc import Sequence
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


def coverage(drives: Sequence[tuple[Episode, LaneTrack]], town: Town) -> Coverage:
    """Follow what several drives of one policy visited, one after the other.

    Args:
        drives: Each drive, and where it was on the lanes.
        town: Where.
    """
    wanted = reachable_lanes(town)
    missing = set(wanted)
    distances, total = [0.0], 0.0
    for episode, lanes in drives:
        steps = np.hypot(
            *np.diff(episode.vehicle[:, :2], axis=0, prepend=episode.vehicle[:1, :2]).T
        )
        along = total + np.cumsum(np.where(episode.on_lane, steps, 0.0))
        runs_with = episode.on_lane & (np.abs(lanes.heading_error) < WRONG_WAY)
        for step in np.flatnonzero(runs_with):
            name = lanes.lane[step]
            if name in missing:
                missing.remove(name)
                distances.append(float(along[step]))
        total = float(along[-1])
    shares = np.arange(len(distances)) / len(wanted)
    return Coverage(
        distance_km=np.array([*distances, total]) / 1000.0,
        share=np.append(shares, shares[-1]),
        lanes=len(wanted),
    )
