"""Angles, frames and polylines in the plane."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float


class Projection(NamedTuple):
    """A point seen from a polyline.

    Attributes:
        station: Arc length of the nearest point [m].
        offset: Signed distance, positive to the left of travel [m].
        segment: Index of the nearest segment.
    """

    station: float
    offset: float
    segment: int


def wrap_angle(angle: float) -> float:
    """Bring an angle into (-pi, pi].

    Args:
        angle: Any angle [rad].

    Returns:
        The same direction in (-pi, pi] [rad].
    """
    return float(np.pi - (np.pi - angle) % (2.0 * np.pi))


def world_from_vehicle(
    points_vehicle: Float[np.ndarray, "N 2"], *, x: float, y: float, yaw: float
) -> Float[np.ndarray, "N 2"]:
    """Bring points from the frame of a vehicle into the world frame.

    Args:
        points_vehicle: Points, x forward and y left [m].
        x: Origin of the vehicle frame in the world [m].
        y: Origin of the vehicle frame in the world [m].
        yaw: Heading of the vehicle [rad].

    Returns:
        The points in the world frame [m].
    """
    cos, sin = np.cos(yaw), np.sin(yaw)
    world_from_vehicle_rotation = np.array([[cos, -sin], [sin, cos]])
    return points_vehicle @ world_from_vehicle_rotation.T + np.array([x, y])


def vehicle_from_world(
    points_world: Float[np.ndarray, "N 2"], *, x: float, y: float, yaw: float
) -> Float[np.ndarray, "N 2"]:
    """Bring points from the world frame into the frame of a vehicle; undoes `world_from_vehicle`.

    Args:
        points_world: Points in the world frame [m].
        x: Origin of the vehicle frame in the world [m].
        y: Origin of the vehicle frame in the world [m].
        yaw: Heading of the vehicle [rad].

    Returns:
        The points, x forward and y left [m].
    """
    cos, sin = np.cos(yaw), np.sin(yaw)
    vehicle_from_world_rotation = np.array([[cos, sin], [-sin, cos]])
    return (points_world - np.array([x, y])) @ vehicle_from_world_rotation.T


def stations(points: Float[np.ndarray, "N 2"]) -> Float[np.ndarray, " N"]:
    """Measure the arc length from the first point of a polyline to each point.

    Args:
        points: Polyline with at least one point [m].

    Returns:
        Arc lengths, starting with 0 [m].
    """
    steps = np.hypot(*np.diff(points, axis=0).T)
    return np.concatenate([[0.0], np.cumsum(steps)])


def resample(points: Float[np.ndarray, "N 2"], spacing: float) -> Float[np.ndarray, "M 2"]:
    """Lay points at equal distances along a polyline; the last gap may be shorter.

    Args:
        points: Polyline [m]; repeated points are allowed.
        spacing: Distance between the new points along the line [m].

    Returns:
        New polyline with the same ends [m].
    """
    station = stations(points)
    wanted = np.append(np.arange(0.0, station[-1] - 1e-6, spacing), station[-1])
    return np.stack([np.interp(wanted, station, points[:, axis]) for axis in (0, 1)], axis=1)


def headings(points: Float[np.ndarray, "N 2"]) -> Float[np.ndarray, " N"]:
    """Direction of travel at each point of a polyline, by central differences.

    Args:
        points: Polyline with at least two distinct points [m].

    Returns:
        Yaw in (-pi, pi] [rad].
    """
    forward = np.empty_like(points)
    forward[1:-1] = points[2:] - points[:-2]
    forward[0] = points[1] - points[0]
    forward[-1] = points[-1] - points[-2]
    yaw = np.arctan2(forward[:, 1], forward[:, 0])
    return np.where(yaw <= -np.pi, np.pi, yaw)


def curvatures(points: Float[np.ndarray, "N 2"]) -> Float[np.ndarray, " N"]:
    """Curvature at each point of a polyline, positive to the left.

    Args:
        points: Polyline with distinct neighbours [m].

    Returns:
        Change of heading over arc length [1/m]; the ends repeat their neighbours.
    """
    if len(points) < 3:
        return np.zeros(len(points))
    steps = np.diff(points, axis=0)
    yaw = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    lengths = np.hypot(*steps.T)
    inner = np.diff(yaw) / (0.5 * (lengths[1:] + lengths[:-1]))
    return np.concatenate([inner[:1], inner, inner[-1:]])


def offset_polyline(
    points: Float[np.ndarray, "N 2"], offset: float | Float[np.ndarray, " N"]
) -> Float[np.ndarray, "N 2"]:
    """Shift each point of a polyline sideways.

    Args:
        points: Polyline [m].
        offset: Distance, one for all points or one each, positive to the left of travel [m].

    Returns:
        As many points, shifted along their normals [m].
    """
    yaw = headings(points)
    normals = np.stack([-np.sin(yaw), np.cos(yaw)], axis=1)
    return points + np.reshape(offset, (-1, 1)) * normals


def project(
    points: Float[np.ndarray, "N 2"],
    point: Float[np.ndarray, "2"],
    *,
    first_segment: int = 0,
    last_segment: int | None = None,
) -> Projection:
    """Project a point onto a polyline.

    Args:
        points: Polyline with at least two points [m].
        point: Point to project [m].
        first_segment: First segment to look at, to follow a line that crosses itself.
        last_segment: Last segment to look at (inclusive); the end of the line if None.

    Returns:
        Station along the whole line, signed offset and segment of the nearest point.
    """
    stop = len(points) - 1 if last_segment is None else min(last_segment + 1, len(points) - 1)
    start = points[first_segment:stop]
    along = points[first_segment + 1 : stop + 1] - start
    length = np.hypot(*along.T)
    relative = point - start
    squared = np.maximum(length**2, np.finfo(float).tiny)  # a segment may be a point
    fraction = np.clip(np.sum(relative * along, axis=1) / squared, 0.0, 1.0)
    gap = relative - fraction[:, None] * along
    distance = np.hypot(*gap.T)
    best = int(np.argmin(distance))
    side = along[best, 0] * relative[best, 1] - along[best, 1] * relative[best, 0]
    before = float(np.sum(np.hypot(*np.diff(points[: first_segment + best + 1], axis=0).T)))
    return Projection(
        station=before + float(fraction[best] * length[best]),
        offset=float(np.copysign(distance[best], side)),
        segment=first_segment + best,
    )
