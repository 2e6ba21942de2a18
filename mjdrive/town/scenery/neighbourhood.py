"""Remembers what stands where, so that only what is near has to be looked at."""

from collections import defaultdict
from collections.abc import Iterator
from itertools import product
from math import floor
from typing import Generic, TypeVar

Thing = TypeVar("Thing")

Box = tuple[float, float, float, float]
"""West, south, east and north [m]."""


class Neighbourhood(Generic[Thing]):
    """Things on the ground, sorted into squares.

    Args:
        cell: Side of a square, about the size of the things [m].
    """

    def __init__(self, cell: float) -> None:
        self._cell = cell
        self._squares: defaultdict[tuple[int, int], list[tuple[int, Thing]]] = defaultdict(list)
        self._count = 0

    def add(self, thing: Thing, box: Box) -> None:
        """Put a thing down.

        Args:
            thing: The thing.
            box: Holds it, world frame [m].
        """
        for square in self._under(box):
            self._squares[square].append((self._count, thing))
        self._count += 1

    def near(self, box: Box) -> list[Thing]:
        """Find all things that may reach into a box, and some beside it, in the order in which they came."""
        found: dict[int, Thing] = {}
        for square in self._under(box):
            found.update(self._squares.get(square, ()))
        return [found[number] for number in sorted(found)]

    def _under(self, box: Box) -> Iterator[tuple[int, int]]:
        west, south, east, north = (floor(side / self._cell) for side in box)
        return product(range(west, east + 1), range(south, north + 1))
