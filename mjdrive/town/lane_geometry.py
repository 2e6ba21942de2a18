"""Where the lanes of an OpenDRIVE road run."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from mjdrive.town.road_map import Road
from mjdrive.town.road_shapes import Arc, Cubic, Piece

LARGEST_GAP = 0.5
"""Largest distance between two points of a centre line [m]."""

CHORD_ERROR = 0.0005
"""Largest distance of the polyline of a reference line from its true arc [m]."""


def evaluate(cubics: Sequence[Cubic], s: Float[np.ndarray, " N"]) -> Float[np.ndarray, " N"]:
    """Evaluate cubics that follow each other.

    Args:
        cubics: In order of their starts; 0 everywhere if there are none.
        s: Where, in the frame of the starts [m].

    Returns:
        Their values [m].
    """
    if not cubics:
        return np.zeros_like(s)
    starts = np.array([cubic.start for cubic in cubics])
    index = np.clip(np.searchsorted(starts, s + 1e-9, side="right") - 1, 0, None)
    a, b, c, d = (np.array([getattr(cubic, name) for cubic in cubics])[index] for name in "abcd")
    ds = s - starts[index]
    value: Float[np.ndarray, " N"] = a + ds * (b + ds * (c + ds * d))
    return value


def reference_line(
    pieces: Sequence[Piece], s: Float[np.ndarray, " N"]
) -> tuple[Float[np.ndarray, "N 2"], Float[np.ndarray, " N"]]:
    """Evaluate the reference line of a road.

    Args:
        pieces: Lines and arcs in order.
        s: Where along the road [m].

    Returns:
        Points in the world frame, shape (N, 2) [m], and headings, shape (N,) [rad].
    """
    starts = np.array([piece.s for piece in pieces])
    index = np.clip(np.searchsorted(starts, s + 1e-9, side="right") - 1, 0, None)
    x, y, heading = (
        np.array([getattr(piece, name) for piece in pieces])[index]
        for name in ("x", "y", "heading")
    )
    curvature = np.array([curvature_of(piece) for piece in pieces])[index]
    ds = s - starts[index]
    # A chord of an arc: its length is ds sinc(angle / 2), its direction the mean heading.
    half_angle = 0.5 * curvature * ds
    chord = ds * np.sinc(half_angle / np.pi)
    points = np.stack(
        [x + chord * np.cos(heading + half_angle), y + chord * np.sin(heading + half_angle)], axis=1
    )
    return points, heading + 2.0 * half_angle


def curvature_of(piece: Piece) -> float:
    """Curvature of a line or an arc [1/m]."""
    return piece.shape.curvature if isinstance(piece.shape, Arc) else 0.0


def section_bounds(road: Road, section_index: int) -> tuple[float, float]:
    """Tell where a lane section starts and ends along its road [m]."""
    following = road.sections[section_index + 1 : section_index + 2]
    return road.sections[section_index].s, following[0].s if following else road.length


def lane_centre(
    road: Road, section_index: int, lane_id: int
) -> tuple[Float[np.ndarray, "N 2"], Float[np.ndarray, " N"]]:
    """Sample the centre line of a lane in the direction of s.

    Args:
        road: Road of the lane.
        section_index: Index of its lane section.
        lane_id: Signed lane number, not 0.

    Returns:
        Points in the world frame, shape (N, 2) [m], and widths there, shape (N,) [m].
    """
    section = road.sections[section_index]
    s = _sample(road, section_index)
    side = np.sign(lane_id)
    inner = [lane for lane in section.lanes if 0 < lane.id * side < abs(lane_id)]
    own = next(lane for lane in section.lanes if lane.id == lane_id)
    width = evaluate(own.widths, s - section.s)
    distance = sum((evaluate(lane.widths, s - section.s) for lane in inner), 0.5 * width)
    offset = evaluate(road.lane_offsets, s) + side * distance
    points, heading = reference_line(road.pieces, s)
    return points + offset[:, None] * np.stack([-np.sin(heading), np.cos(heading)], axis=1), width


def _sample(road: Road, section_index: int) -> Float[np.ndarray, " N"]:
    """Choose stations of a section: piece ends, and between them as dense as the bends ask for."""
    start, end = section_bounds(road, section_index)
    ends = [piece.s for piece in road.pieces if start < piece.s < end]
    knots = [start, *ends, end]
    stations = [np.array([start])]
    for left, right in pairwise(knots):
        if right - left < 1e-6:
            continue
        piece = max((p for p in road.pieces if p.s <= 0.5 * (left + right)), key=lambda p: p.s)
        gap = LARGEST_GAP
        if curvature := curvature_of(piece):
            gap = min(gap, np.sqrt(8.0 * CHORD_ERROR / abs(curvature)))
        stations.append(np.linspace(left, right, int(np.ceil((right - left) / gap)) + 1)[1:])
    return np.concatenate(stations)
