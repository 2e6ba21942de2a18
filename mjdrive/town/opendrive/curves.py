"""The curves that reference lines are made of, each in the frame of its start.

Reference:
    ASAM OpenDRIVE 1.8, chapter 9 (geometries of the road reference line).
"""

from functools import lru_cache

import numpy as np
from jaxtyping import Float

from mjdrive.town.opendrive.road_shapes import Arc, Line, ParamPoly3, Poly3, Shape, Spiral

_NODES, _WEIGHTS = (np.polynomial.legendre.leggauss(10)[0], np.polynomial.legendre.leggauss(10)[1])
"""Gauss-Legendre rule on [-1, 1]."""

_LENGTH_ERROR = 1e-9
"""Largest error of the length of a polynomial curve, relative to its length or to 1 m [-]."""

_MOST_CELLS = 4096
"""Largest number of stretches that a polynomial curve is measured in."""

_NEWTON_STEPS = 6

Curve = tuple[Float[np.ndarray, " N"], Float[np.ndarray, " N"], Float[np.ndarray, " N"]]


def curve(shape: Shape, length: float, s: Float[np.ndarray, " N"]) -> Curve:
    """Evaluate a curve by arc length.

    Args:
        shape: Which curve.
        length: Its length [m].
        s: Arc length from its start; a little beyond its ends is allowed [m].

    Returns:
        u along the heading of the start [m], v to its left [m] and the heading against it [rad].
    """
    match shape:
        case Line():
            return arc(np.zeros_like(s), s)
        case Arc(curvature):
            return arc(np.full_like(s, curvature), s)
        case Spiral(start, end):
            return _clothoid(start, (end - start) / length, length, s)
        case _:
            return _polynomial(shape, length, s)


def arc(curvature: Float[np.ndarray, " N"], s: Float[np.ndarray, " N"]) -> Curve:
    """Evaluate arcs by arc length; a curvature of 0 makes a line.

    Args:
        curvature: Of each arc, positive to the left [1/m].
        s: Arc length from its start [m].

    Returns:
        u along the heading of the start [m], v to its left [m] and the heading against it [rad].
    """
    # A chord of an arc: its length is s sinc(angle / 2), its direction half the angle.
    half_angle = 0.5 * curvature * s
    chord = s * np.sinc(half_angle / np.pi)
    return chord * np.cos(half_angle), chord * np.sin(half_angle), 2.0 * half_angle


def _clothoid(start: float, rate: float, length: float, s: Float[np.ndarray, " N"]) -> Curve:
    """Integrate cos and sin of the heading start s + rate s^2 / 2, over stretches that turn by 1 rad at most."""
    largest = max(abs(start), abs(start + rate * length))
    knots = np.linspace(0.0, length, int(np.ceil(largest * length)) + 2)
    cells = np.clip(np.searchsorted(knots, s, side="right") - 1, 0, len(knots) - 2)

    def integrals(left: np.ndarray, right: np.ndarray) -> np.ndarray:
        t = 0.5 * (left + right)[:, None] + 0.5 * (right - left)[:, None] * _NODES
        heading = t * (start + 0.5 * rate * t)
        values = np.stack([np.cos(heading), np.sin(heading)])  # (2, N, node)
        return 0.5 * (right - left) * (values @ _WEIGHTS)

    whole = np.cumsum(integrals(knots[:-1], knots[1:]), axis=1)
    before = np.concatenate([np.zeros((2, 1)), whole], axis=1)
    u, v = before[:, cells] + integrals(knots[cells], s)
    return u, v, s * (start + 0.5 * rate * s)


def curve_length(shape: ParamPoly3, length: float) -> float:
    """Measure a parametric curve whose piece claims a length [m]."""
    return float(_arc_table(*_coefficients(shape), _range(shape, length))[1][-1])


def _polynomial(shape: Poly3 | ParamPoly3, length: float, s: Float[np.ndarray, " N"]) -> Curve:
    """Find the parameter at each arc length, then evaluate the cubics there."""
    u, v = _coefficients(shape)
    inside = np.clip(s, 0.0, length)
    if isinstance(shape, Poly3):
        # u is the parameter and its range follows from the length.
        p = _parameter(u, v, _poly3_range(u, v, length), inside)
    else:
        # Lengths in files are rounded: stretched, so that the end of the piece is the end of the curve.
        table = _range(shape, length)
        p = _parameter(u, v, table, inside * (curve_length(shape, length) / length))
    du, dv = _slope(u, p), _slope(v, p)
    heading = np.arctan2(dv, du)
    beyond = s - inside
    return (
        _value(u, p) + beyond * np.cos(heading),
        _value(v, p) + beyond * np.sin(heading),
        heading,
    )


Cubic4 = tuple[float, float, float, float]


def _coefficients(shape: Poly3 | ParamPoly3) -> tuple[Cubic4, Cubic4]:
    if isinstance(shape, Poly3):
        return (0.0, 1.0, 0.0, 0.0), (shape.a, shape.b, shape.c, shape.d)
    return shape.u, shape.v


def _range(shape: ParamPoly3, length: float) -> float:
    return 1.0 if shape.is_normalized else length


def _value(cubic: Cubic4, p: np.ndarray) -> np.ndarray:
    a, b, c, d = cubic
    return a + p * (b + p * (c + p * d))


def _slope(cubic: Cubic4, p: np.ndarray) -> np.ndarray:
    _, b, c, d = cubic
    return b + p * (2.0 * c + 3.0 * p * d)


def _stretch_lengths(u: Cubic4, v: Cubic4, left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Arc length between pairs of parameters [m]."""
    p = 0.5 * (left + right)[:, None] + 0.5 * (right - left)[:, None] * _NODES
    return 0.5 * (right - left) * (np.hypot(_slope(u, p), _slope(v, p)) @ _WEIGHTS)


@lru_cache(maxsize=4096)
def _arc_table(u: Cubic4, v: Cubic4, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Parameters from 0 to an end, and the arc length up to each, in steps as small as the length asks for."""
    cells = 8
    knots = np.linspace(0.0, end, cells + 1)
    lengths = _stretch_lengths(u, v, knots[:-1], knots[1:])
    while cells < _MOST_CELLS:
        cells *= 2
        finer_knots = np.linspace(0.0, end, cells + 1)
        finer = _stretch_lengths(u, v, finer_knots[:-1], finer_knots[1:])
        error = np.abs(finer.reshape(-1, 2).sum(axis=1) - lengths).sum()
        knots, lengths = finer_knots, finer
        if error <= _LENGTH_ERROR * max(1.0, float(lengths.sum())):
            break
    return knots, np.concatenate([[0.0], np.cumsum(lengths)])


@lru_cache(maxsize=4096)
def _poly3_range(u: Cubic4, v: Cubic4, length: float) -> float:
    """A parameter up to which a graph v(u) is at least that long, and less than twice as far as needed."""
    end = length
    for _ in range(100):
        if _arc_table(u, v, 0.5 * end)[1][-1] < length:
            break
        end *= 0.5
    return end


def _parameter(u: Cubic4, v: Cubic4, end: float, s: np.ndarray) -> np.ndarray:
    """Invert the arc length by Newton's method in the stretch where each place lies."""
    knots, lengths = _arc_table(u, v, end)
    cells = np.clip(np.searchsorted(lengths, s, side="right") - 1, 0, len(knots) - 2)
    left, right = knots[cells], knots[cells + 1]
    whole = np.maximum(lengths[cells + 1] - lengths[cells], 1e-12)
    wanted = s - lengths[cells]
    p = left + (right - left) * np.clip(wanted / whole, 0.0, 1.0)
    for _ in range(_NEWTON_STEPS):
        speed = np.maximum(np.hypot(_slope(u, p), _slope(v, p)), 1e-12)
        p = np.clip(p - (_stretch_lengths(u, v, left, p) - wanted) / speed, left, right)
    return p
