"""Where a car is along the smooth line that the points of a route stand for."""

import numpy as np

from mjdrive import geometry
from mjdrive.datatypes import Situation


def frenet_state(view: Situation) -> tuple[float, float]:
    """Offset and heading of a car against its route, without the corners of the polyline.

    A route is a chain of chords of 1 m; on a bend of 4 m radius their middles lie 3 cm inside the arc, which would make an
    expert that takes them at their word twitch once a metre.

    Args:
        view: The car on its route.

    Returns:
        Distance from the arc, positive to the left [m], and heading against its tangent in (-pi, pi] [rad].
    """
    route, station = view.route, view.station
    last = len(route.station) - 2
    index = min(max(int(np.searchsorted(route.station, station, side="right")) - 1, 0), last)
    begin, end = route.station[index], route.station[index + 1]
    along = min(max(station - begin, 0.0), end - begin)
    curvature = 0.5 * (route.curvature[index] + route.curvature[index + 1])
    sagitta = 0.5 * curvature * along * (end - begin - along)
    turned = geometry.wrap_angle(float(route.yaw[index + 1] - route.yaw[index]))
    tangent = route.yaw[index] + turned * along / (end - begin)
    heading_error = geometry.wrap_angle(view.vehicle.yaw - float(tangent))
    return float(view.offset + sagitta), heading_error
