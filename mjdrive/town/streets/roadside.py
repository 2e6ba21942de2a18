"""Lights and signs beside the streets of a plan."""

import numpy as np

from mjdrive.geometry import project
from mjdrive.town.opendrive.reference_line import reference_line
from mjdrive.town.opendrive.road_map import Road, SignalRecord
from mjdrive.town.opendrive.vocabulary import SPEED_LIMIT_TYPE, TRAFFIC_LIGHT_TYPE
from mjdrive.town.streets.street_ends import contact
from mjdrive.town.streets.street_plan import LightPlan, SpeedSignPlan, StreetPlan

_POLE_BEHIND_KERB = 0.4
"""Distance of a pole from the kerb where the plan does not say [m]."""

_PROJECTION_STEP = 0.1
"""Distance between the points of a reference line that signs are projected on [m]."""


def light_signal(plan: StreetPlan, node: str, light: LightPlan, road: Road) -> SignalRecord:
    """Put a traffic light where a street meets a junction.

    Args:
        plan: The street plan.
        node: Node of the junction.
        light: The light.
        road: The street.

    Returns:
        Its signal, which holds for the lane that leads to the junction.
    """
    lane = -1 if contact(plan, light.road, node) == "end" else 1
    if light.pole is None:
        widths = plan.cross_section
        s = road.length if lane < 0 else 0.0
        t = float(lane) * (widths.lane + widths.shoulder + _POLE_BEHIND_KERB)
    else:
        line = road.pieces[-1] if lane < 0 else road.pieces[0]
        along = np.array([np.cos(line.heading), np.sin(line.heading)])
        relative = np.array(light.pole) - np.array([line.x, line.y])
        # A pole may stand a little behind the end of its road; the standard keeps s on the road.
        s = float(np.clip(line.s + relative @ along, 0.0, road.length))
        t = float(along[0] * relative[1] - along[1] * relative[0])
    return SignalRecord(
        id=light.id,
        name=f"Light {light.id}",
        type=TRAFFIC_LIGHT_TYPE,
        s=round(s, 9),
        t=round(t, 9),
        orientation="+" if lane < 0 else "-",
        from_lane=lane,
        to_lane=lane,
    )


def sign_signal(sign: SpeedSignPlan, road: Road) -> SignalRecord:
    """Put a speed limit sign beside a street.

    Args:
        sign: The sign.
        road: The street.

    Returns:
        Its signal, which holds for the lane on its side.
    """
    steps = np.linspace(0.0, road.length, int(np.ceil(road.length / _PROJECTION_STEP)) + 1)
    points, _ = reference_line(road.pieces, steps)
    seen = project(points, np.array(sign.at))
    (point,), (heading,) = reference_line(road.pieces, np.array([seen.station]))
    relative = np.array(sign.at) - point
    t = float(np.cos(heading) * relative[1] - np.sin(heading) * relative[0])
    lane = -1 if t < 0.0 else 1
    return SignalRecord(
        id=sign.id,
        name=f"Speed limit {sign.limit_kmh:g}",
        type=SPEED_LIMIT_TYPE,
        s=round(min(seen.station, road.length), 9),
        t=round(t, 9),
        orientation="+" if lane < 0 else "-",
        from_lane=lane,
        to_lane=lane,
        dynamic=False,
        value=float(sign.limit_kmh),
        unit="km/h",
    )
