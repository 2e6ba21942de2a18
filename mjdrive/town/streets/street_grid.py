"""A grid of streets with some left out, as a graph: what the town generator lays its streets on."""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

Node = tuple[int, int]
"""Column and row of a crossing of the grid."""

Chain = tuple[Node, ...]
"""Crossings that one way leads through: both ends are junctions, nothing branches off between them."""

LEAST_JUNCTION = 3
"""Streets that meet at a junction, at least [-]."""


class GridSize(NamedTuple):
    """Lines of a grid.

    Attributes:
        columns: Lines from south to north.
        rows: Lines from west to east.
    """

    columns: int
    rows: int

    @property
    def num_junctions(self) -> int:
        """Junctions of the whole grid: all crossings but its four corners."""
        return self.columns * self.rows - 4


class StreetGrid:
    """The streets of a grid between neighbouring crossings, of which some may be left out.

    Every crossing with streets has two or more, so nothing is a dead end.

    Args:
        size: Lines of the grid, at least two each way.
    """

    def __init__(self, size: GridSize) -> None:
        self._neighbours: dict[Node, set[Node]] = {
            (column, row): {
                (column + east, row + north)
                for east, north in ((1, 0), (0, 1), (-1, 0), (0, -1))
                if 0 <= column + east < size.columns and 0 <= row + north < size.rows
            }
            for column in range(size.columns)
            for row in range(size.rows)
        }

    def degree(self, node: Node) -> int:
        """Number of streets that meet at a crossing."""
        return len(self._neighbours[node])

    @property
    def junctions(self) -> list[Node]:
        """Crossings where three or four streets meet, in order."""
        return [node for node in self._neighbours if self.degree(node) >= LEAST_JUNCTION]

    def chains(self) -> list[Chain]:
        """List the ways between junctions, each once, in order."""
        return [
            chain
            for junction in self.junctions
            for chain in self._chains_from(junction)
            if chain <= chain[::-1]
        ]

    def _chains_from(self, junction: Node) -> Iterator[Chain]:
        for neighbour in sorted(self._neighbours[junction]):
            chain = [junction, neighbour]
            while self.degree(chain[-1]) < LEAST_JUNCTION:
                (following,) = self._neighbours[chain[-1]] - {chain[-2]}
                chain.append(following)
            yield tuple(chain)

    def loss(self, chain: Chain) -> int:
        """Tell how many junctions stop being one when a chain is left out."""
        return sum(self.degree(end) == LEAST_JUNCTION for end in (chain[0], chain[-1]))

    def leave_out(self, chain: Chain) -> bool:
        """Leave out the streets of a chain, unless the town would fall apart.

        Args:
            chain: One of `chains()`.

        Returns:
            Whether it was left out.
        """
        if chain[0] == chain[-1]:
            return False
        steps = list(pairwise(chain))
        for here, there in steps:
            self._neighbours[here].remove(there)
            self._neighbours[there].remove(here)
        if self._is_connected():
            return True
        for here, there in steps:
            self._neighbours[here].add(there)
            self._neighbours[there].add(here)
        return False

    def _is_connected(self) -> bool:
        left = {node for node, neighbours in self._neighbours.items() if neighbours}
        reached = [next(iter(sorted(left)))]
        left.remove(reached[0])
        for node in reached:
            found = self._neighbours[node] & left
            left -= found
            reached.extend(sorted(found))
        return not left


def thin_out(size: GridSize, *, num_junctions: int, rng: np.random.Generator) -> StreetGrid | None:
    """Leave streets out of a whole grid until a number of junctions is left.

    Args:
        size: Lines of the grid.
        num_junctions: Junctions to keep [-].
        rng: Source of the choices.

    Returns:
        The grid, or None if this order of choices comes to no such grid.
    """
    grid = StreetGrid(size)
    while (surplus := len(grid.junctions) - num_junctions) > 0:
        if not _leave_one_out(grid, largest_loss=surplus, rng=rng):
            return None
    if surplus < 0:
        return None
    # Streets between two 4-way junctions may go without loss: some do, so that T-junctions mix in.
    num_crosses = sum(grid.degree(node) > LEAST_JUNCTION for node in grid.junctions)
    for _ in range(int(rng.integers(num_crosses // 4 + 1))):
        _leave_one_out(grid, largest_loss=0, rng=rng)
    return grid


def _leave_one_out(grid: StreetGrid, *, largest_loss: int, rng: np.random.Generator) -> bool:
    """Leave out a chain that costs few enough junctions; False if none may go."""
    chains = [chain for chain in grid.chains() if grid.loss(chain) <= largest_loss]
    return any(grid.leave_out(chains[index]) for index in rng.permutation(len(chains)))
