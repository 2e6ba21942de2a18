"""Concrete barriers across the lanes of a town, to drive into."""

import dataclasses

import numpy as np

from mjdrive.datatypes import StaticObject, Town

SIZE = (0.5, 6.0, 0.9)  # length along the lane, width across it, height [m]


def with_barriers(town: Town, number: int) -> Town:
    """Stand concrete barriers across some lanes, as towns of our own have no objects.

    Args:
        town: The town.
        number: How many, about [-].
    """
    lanes = [
        lane for lane in town.lanes.values() if lane.junction is None and len(lane.centerline) > 2
    ]
    barriers = []
    for index, lane in enumerate(lanes[:: max(len(lanes) // number, 1)]):
        middle = len(lane.centerline) // 2
        ahead = lane.centerline[middle] - lane.centerline[middle - 1]
        ahead = ahead / np.hypot(*ahead)
        along = 0.5 * SIZE[0] * ahead
        across = 0.5 * SIZE[1] * np.array([-ahead[1], ahead[0]])
        corners = [along - across, along + across, -along + across, -along - across]
        outline = lane.centerline[middle] + np.array(corners)
        barriers.append(StaticObject(f"barrier{index}", "barrier", outline, height=SIZE[2]))
    return dataclasses.replace(town, objects=(*town.objects, *barriers))
