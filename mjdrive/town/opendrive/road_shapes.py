"""Curves, cubics and marks that a road is drawn with, in the words of OpenDRIVE."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Line:
    """A straight stretch."""


@dataclass(frozen=True, slots=True)
class Arc:
    """A stretch of constant curvature.

    Attributes:
        curvature: Positive to the left [1/m].
    """

    curvature: float


@dataclass(frozen=True, slots=True)
class Spiral:
    """A clothoid: its curvature changes evenly with arc length.

    Attributes:
        start_curvature: Positive to the left [1/m].
        end_curvature: Positive to the left [1/m].
    """

    start_curvature: float
    end_curvature: float


@dataclass(frozen=True, slots=True)
class Poly3:
    """A cubic v(u) = a + b u + c u^2 + d u^3 in the frame of the start, u along its heading and v to the left [m].

    Attributes:
        a: [m].
        b: [-].
        c: [1/m].
        d: [1/m^2].
    """

    a: float
    b: float
    c: float
    d: float


@dataclass(frozen=True, slots=True)
class ParamPoly3:
    """Two cubics u(p) and v(p) in the frame of the start, u along its heading and v to the left [m].

    Attributes:
        u: Four coefficients, constant first.
        v: Four coefficients, constant first.
        is_normalized: Whether p runs from 0 to 1; from 0 to the length of the piece otherwise [m].
    """

    u: tuple[float, float, float, float]
    v: tuple[float, float, float, float]
    is_normalized: bool


Shape = Line | Arc | Spiral | Poly3 | ParamPoly3


@dataclass(frozen=True, slots=True)
class Piece:
    """A stretch of a reference line.

    Attributes:
        s: Where the piece starts on its road [m].
        x: Start, world frame [m].
        y: Start, world frame [m].
        heading: Direction of the frame of the start [rad].
        length: Arc length [m].
        shape: How it runs.
    """

    s: float
    x: float
    y: float
    heading: float
    length: float
    shape: Shape = Line()


@dataclass(frozen=True, slots=True)
class Cubic:
    """A cubic polynomial a + b ds + c ds^2 + d ds^3 that holds from `start` to the next one.

    Attributes:
        start: Where it begins [m]; on its road (lane offset) or in its lane section (width).
        a: Value at the start [m].
        b: First order [-].
        c: Second order [1/m].
        d: Third order [1/m^2].
    """

    start: float
    a: float
    b: float = 0.0
    c: float = 0.0
    d: float = 0.0


@dataclass(frozen=True, slots=True)
class RoadMark:
    """The mark along the outer edge of a lane (along the middle for lane 0), from `start` to the next one.

    Attributes:
        type: "none", "broken", "solid", "solid solid", "solid broken", "broken solid", "broken broken", "curb" and others.
        color: One of `vocabulary.MARK_COLORS`.
        width: Width of the mark; 0 if the map does not say [m].
        start: Where it begins, in its lane section [m].
        dash: Length of a dash; 0 if the map does not say [m].
        gap: Between two dashes; 0 if the map does not say [m].
    """

    type: str = "none"
    color: str = "standard"
    width: float = 0.0
    start: float = 0.0
    dash: float = 0.0
    gap: float = 0.0
