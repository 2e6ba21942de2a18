"""Which ways through junctions a drive took: the choices that make driving multimodal."""

from collections import Counter

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Episode, Lane, Town

GATE_RADIUS = 2.5
"""A lane end counts as passed when the rear axle comes this near to it [m]."""

GATE_HEADING = 0.7
"""Smallest cosine between the heading of the car and that of the lane at its end [-]."""


def branches_taken(episode: Episode, town: Town) -> dict[str, int]:
    """Count the ways through junctions that were driven from their first point to their last.

    Args:
        episode: The drive.
        town: The town that it was driven in.

    Returns:
        How often each junction lane was driven, by name, in order of the names; lanes not driven are left out.
    """
    return dict(sorted(Counter(lane for _, lane in branch_passages(episode, town)).items()))


def branch_passages(episode: Episode, town: Town) -> list[tuple[int, str]]:
    """List the ways through junctions that were driven from their first point to their last.

    Lanes of one approach begin at the same point, so the way is known at the end: a lane counts when its start was
    the last entrance passed before its end.

    Args:
        episode: The drive.
        town: The town that it was driven in.

    Returns:
        The step at which each was driven to its end, and the name of the junction lane, in the order of driving.
    """
    entered: dict[str, int] = {}
    events: list[
        tuple[int, int, Lane]
    ] = []  # (step, 1 entrance or 0 exit, lane); an exit goes before an entrance
    for lane in town.lanes.values():
        if lane.junction is not None:
            events += [(step, 1, lane) for step in _passages(episode.vehicle, lane, end=0)]
            events += [(step, 0, lane) for step in _passages(episode.vehicle, lane, end=-1)]
    driven: list[tuple[int, str]] = []
    for step, is_entrance, lane in sorted(events, key=lambda event: (event[:2], event[2].id)):
        if is_entrance:
            entered = {name: at for name, at in entered.items() if at == step} | {lane.id: step}
        elif entered.pop(lane.id, None) is not None:
            driven.append((step, lane.id))
            entered.clear()
    return driven


def _passages(vehicle: Float[np.ndarray, "T 6"], lane: Lane, *, end: int) -> list[int]:
    """Steps at which the car was nearest to one end of a lane, one for each time that it came by."""
    point, neighbour = lane.centerline[end], lane.centerline[1 if end == 0 else -2]
    along = (neighbour - point) if end == 0 else (point - neighbour)
    yaw = np.arctan2(along[1], along[0])
    distance = np.hypot(*(vehicle[:, :2] - point).T)
    is_near = (distance < GATE_RADIUS) & (np.cos(vehicle[:, 2] - yaw) > GATE_HEADING)
    edges = np.flatnonzero(np.diff(is_near, prepend=False, append=False))
    return [
        int(first + np.argmin(distance[first:last]))
        for first, last in zip(edges[::2], edges[1::2], strict=True)
    ]
