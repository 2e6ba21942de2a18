"""From an OpenDRIVE map to the lanes and lights of a `Town`."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Lane, Move, Town
from mjdrive.errors import TownFormatError
from mjdrive.geometry import headings
from mjdrive.town import furniture
from mjdrive.town.lights import build_lights
from mjdrive.town.links import LaneKey, Links
from mjdrive.town.opendrive.cross_section import LaneOfRoad
from mjdrive.town.opendrive.lane_geometry import lane_centres
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.opendrive.vocabulary import DRIVEN_LANE_TYPES
from mjdrive.town.settings import LightTiming

_STRAIGHT_BELOW = np.pi / 4
"""Largest change of heading of a straight move [rad]."""

_SAME_WIDTH = 1e-9
"""Widths closer than this are one [m]."""

_FARTHEST = 1e7
"""Largest coordinate of a lane; one cannot drive further out, and centimetres are lost there [m]."""


def build_town(road_map: RoadMap, *, name: str, timing: LightTiming, digest: str) -> Town:
    """Build the lanes, the lights and the furniture of a town.

    Lanes that do not meet, lead nowhere or are too narrow are built as the map has them; `check.check` finds them.

    Args:
        road_map: The OpenDRIVE map.
        name: Name of the town.
        timing: How long the lights show each signal.
        digest: Digest of what the town is made from.

    Returns:
        The town.

    Raises:
        TownFormatError: If a road, junction, signal or controller is named that the map does not have, if no lane is
            driven or none is wider than 0, or if a lane runs beyond all bounds.
    """
    links = Links(road_map)
    if not links.following:
        raise TownFormatError(
            f"Map '{road_map.name}' has no driving lane; expected lanes of type "
            f"{', '.join(sorted(DRIVEN_LANE_TYPES))}."
        )
    lanes = _lanes(road_map, links)
    if not any(lane.width > 0.0 for lane in lanes.values()):
        raise TownFormatError(
            f"Map '{road_map.name}' has only lanes that are 0 m wide; expected lanes that a car fits into."
        )
    lights = build_lights(road_map, links, lanes, timing)
    for light in lights.values():
        if lanes[light.lane].light is None:
            lanes[light.lane] = replace(lanes[light.lane], light=light.id)
    return Town(
        name=name,
        lanes=lanes,
        lights=lights,
        bounds=_bounds(lanes),
        digest=digest,
        markings=furniture.markings(road_map),
        signs=furniture.signs(road_map),
        objects=furniture.objects(road_map),
        sidewalks=furniture.sidewalks(road_map),
    )


def _lanes(road_map: RoadMap, links: Links) -> dict[str, Lane]:
    keys = list(links.following)
    places = [LaneOfRoad(road_map.roads[key.road], key.section, key.lane) for key in keys]
    # Numbers may be anything: what overflows is refused below.
    with np.errstate(over="ignore", invalid="ignore"):
        return {
            key.name: _lane(road_map, links, key, points, widths)
            for key, (points, widths) in zip(keys, lane_centres(places), strict=True)
        }


def _lane(
    road_map: RoadMap,
    links: Links,
    key: LaneKey,
    points: Float[np.ndarray, "N 2"],
    widths: Float[np.ndarray, " N"],
) -> Lane:
    if not np.all(np.abs(points) < _FARTHEST) or not np.all(np.abs(widths) < _FARTHEST):
        raise TownFormatError(
            f"Lane '{key.name}' runs beyond {_FARTHEST:.0e} m; expected a road network near the origin of the map."
        )
    if not links.runs_along(key):
        points, widths = points[::-1], widths[::-1]
    widths = np.maximum(widths, 0.0)
    left, right = links.neighbours(key)
    junction = road_map.roads[key.road].junction
    return Lane(
        id=key.name,
        centerline=points,
        width=float(widths.mean()),
        successors=tuple(following.name for following in links.following[key]),
        junction=junction,
        light=None,
        move=Move.FOLLOW if junction is None else _move(points),
        widths=None if np.ptp(widths) < _SAME_WIDTH else widths,
        left=None if left is None else left.name,
        right=None if right is None else right.name,
    )


def _move(points: Float[np.ndarray, "N 2"]) -> Move:
    """Tell which way a lane across a junction leads by how far it turns; a full turn counts, as around an island."""
    yaw = np.unwrap(headings(points))
    turn = float(yaw[-1] - yaw[0])
    if abs(turn) < _STRAIGHT_BELOW:
        return Move.STRAIGHT
    return Move.LEFT if turn > 0 else Move.RIGHT


def _bounds(lanes: dict[str, Lane]) -> Float[np.ndarray, "4"]:
    points = np.concatenate([lane.centerline for lane in lanes.values()])
    half_width = 0.5 * max(
        lane.width if lane.widths is None else float(lane.widths.max()) for lane in lanes.values()
    )
    return np.concatenate([points.min(axis=0) - half_width, points.max(axis=0) + half_width])
