import numpy as np

from mjdrive.benchmarks.bev import drive_poses
from mjdrive.datatypes import Town
from mjdrive.town.lane_index import LaneIndex


def test_poses_lie_on_lanes_and_point_along_them(town02: Town) -> None:
    index = LaneIndex(town02)
    poses = drive_poses(town02, 120, np.random.default_rng(0))
    assert len(poses) == 120
    for x, y, yaw in poses:
        places = index.near(x, y)
        assert any(abs(it.offset) < 0.1 and np.cos(it.yaw - yaw) > 0.9 for it in places)
