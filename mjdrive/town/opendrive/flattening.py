"""Heights in a map: mjdrive drives in the plane, so they are measured, and refused or ignored."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from mjdrive.town.opendrive.cross_section import Cubics
from mjdrive.town.opendrive.road_shapes import Cubic
from mjdrive.town.opendrive.xml_fields import Element, XmlFields

FLAT_HEIGHT = 0.01
"""Largest difference in height that still counts as flat [m]."""

FLAT_SLOPE = 0.001
"""Largest slope along or across a road that still counts as flat [-]."""


@dataclass(frozen=True, slots=True)
class Flattening:
    """How much height of a map was ignored.

    Attributes:
        roads: Number of roads that are not flat [-].
        height: Largest difference in height between two places of reference lines [m].
        slope: Steepest slope along or across a road, as its tangent [-].
    """

    roads: int = 0
    height: float = 0.0
    slope: float = 0.0


class HeightGauge:
    """Measures the heights of the roads of one map.

    Args:
        fields: Takes values out of the document.
        flatten: Whether a map that is not flat is read as its plan; it is refused otherwise.
    """

    def __init__(self, fields: XmlFields, *, flatten: bool) -> None:
        self._fields = fields
        self._flatten = flatten
        self._lowest: float | None = None
        self._highest = 0.0
        self._roads = 0
        self._slope = 0.0

    def measure(self, road: Element, length: float) -> None:
        """Measure a road.

        Args:
            road: Its element.
            length: Its length [m].

        Raises:
            TownFormatError: If it is not flat, or not as high as the roads before, and flattening is not asked for.
        """
        lowest, highest, slope = self._profile(road, length)
        slope = max(slope, self._across(road, length))
        is_first = self._lowest is None
        base = lowest if self._lowest is None else self._lowest
        self._lowest = min(base, lowest)
        self._highest = highest if is_first else max(self._highest, highest)
        self._slope = max(self._slope, slope)
        difference = max(highest - base, base - lowest)
        if difference > FLAT_HEIGHT or slope > FLAT_SLOPE:
            self._roads += 1
            if not self._flatten:
                self._fields.fail(
                    road,
                    f"is not flat: heights differ by up to {difference:.3g} m, slopes go up to {slope:.3g}. mjdrive "
                    "drives in the plane; import with --flatten to use the plan of the map.",
                )

    def result(self) -> Flattening:
        """Tell what was ignored on all roads so far."""
        if not self._roads:
            return Flattening()
        return Flattening(self._roads, self._highest - (self._lowest or 0.0), self._slope)

    def _cubics(self, road: Element, *path: str) -> list[Cubic]:
        return [
            Cubic(*(self._fields.number(e, name) for name in ("s", "a", "b", "c", "d")))
            for e in self._fields.each(road, *path)
        ]

    def _profile(self, road: Element, length: float) -> tuple[float, float, float]:
        """Lowest and highest place of the reference line and its steepest slope."""
        cubics = self._cubics(road, "elevationProfile", "elevation")
        slopes = [max(abs(c.b), *_slopes(c, end)) for c, end in _spans(cubics, length)]
        return *_range(cubics, length), max(slopes, default=0.0)

    def _across(self, road: Element, length: float) -> float:
        """Steepest slope across a road: superelevation, crossfall, shapes and strips of a cross-section."""
        fields = self._fields
        slope = 0.0
        for tag in ("superelevation", "crossfall"):
            cubics = self._cubics(road, "lateralProfile", tag)
            smallest, largest = _range(cubics, length)
            slope = max(slope, float(np.tan(min(max(-smallest, largest), 1.5))))
        shapes = list(fields.each(road, "lateralProfile", "shape"))
        rows: dict[float, list[Cubic]] = {}
        for shape in shapes:
            t, *coefficients = (fields.number(shape, name) for name in "tabcd")
            rows.setdefault(fields.number(shape, "s"), []).append(Cubic(t, *coefficients))
        for row in rows.values():
            row.sort(key=lambda cubic: cubic.start)
            for cubic, end in _spans(row, row[-1].start + 1.0):
                slope = max(slope, *_slopes(cubic, end))
        surface = fields.child(road, "lateralProfile", "crossSectionSurface")
        if surface is not None:
            fields.use_all(surface)
            for e in surface.iter("coefficients"):
                slope = max(slope, *(abs(fields.number(e, name, 0.0)) for name in "abcd"))
        return slope


def _spans(cubics: Sequence[Cubic], end: float) -> list[tuple[Cubic, float]]:
    """Each cubic with the place where it ends."""
    starts = [cubic.start for cubic in cubics]
    return list(zip(cubics, [*starts[1:], end], strict=True)) if cubics else []


def _slopes(cubic: Cubic, end: float) -> list[float]:
    """Sizes of the slope of a cubic at its ends and where it is steepest between them."""
    span = max(end - cubic.start, 0.0)
    places = [0.0, span]
    if cubic.d:
        steepest = -cubic.c / (3.0 * cubic.d)
        places.append(min(max(steepest, 0.0), span))
    return [abs(cubic.b + ds * (2.0 * cubic.c + 3.0 * cubic.d * ds)) for ds in places]


def _range(cubics: Sequence[Cubic], length: float) -> tuple[float, float]:
    """Smallest and largest value of cubics along a road, 0 if there are none."""
    if not any(c.b or c.c or c.d for c in cubics):
        steps = [c.a for c in cubics if c.start < length] or [c.a for c in cubics[:1]] or [0.0]
        return min(steps), max(steps)
    knots = sorted({0.0, length, *(c.start for c in cubics if 0.0 < c.start < length)})
    # Dense enough to find the largest value of cubics.
    s = np.unique(np.concatenate([np.linspace(a, b, 33) for a, b in pairwise(knots)]))
    values = Cubics([cubics]).at(np.zeros(len(s), dtype=int), s)
    return float(values.min()), float(values.max())
