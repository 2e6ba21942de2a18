"""Energies of a whole grid of actions: between neighbouring actions the energy is all but linear.

For one observation the units of the first hidden layer are linear in the two numbers of an action, but for the hinge of
their rectifier. Over a tile of neighbouring actions few of them reach it: the others are off, or on, all over the tile.
The same goes for the second layer, by bounds on what reaches it. So a value and two slopes stand for all units that stay
on one side, and only the others are computed action by action: of 256 in each layer about 25 and 15 in a network with
first weights, 37 and 20 in `zoo:da-ibc` (tiles of 16 x 16 actions out of 128 x 128). Tiles with many are cut in four.

No unit that changes sides is left out, so these are the energies of the network up to the rounding of float32.
"""

import math
from typing import NamedTuple

import torch
from jaxtyping import Float, Int
from torch import Tensor
from torch.nn import functional as F  # noqa: N812

from models.energy import HIDDEN_SIZE, EnergyHead
from models.interfaces import ACTION_SIZE
from models.threads import for_each, one_thread

# T tiles, S actions along a side, P = S * S actions of a tile, H hidden units, K of the first layer and M of the second
# that are computed action by action; 3 numbers: at the centre of a tile, by acceleration, by steering.

# Each tile costs products with all units, but small ones have fewer units that change sides. Found by timing, as are the
# next three.
ACTIONS_ALONG_A_SIDE = 16
TILES_AT_A_TIME = 32
# A tile that takes more multiplications than this action by action is quicker in four.
MOST_PRODUCTS = 1.5e6
# What lies between layers is 1 MB or so.
NUMBERS_AT_A_TIME = 2**18
SMALLEST = torch.finfo(torch.float32).tiny


class Outline(NamedTuple):
    """What is known of tiles before their actions are looked at one by one.

    Attributes:
        offsets: One, and how far actions lie off the centre, shape (T, 3, P) [-].
        first: Units of the first layer before the hinge, shape (T, 3, H) [-].
        chords: The same behind it, with half the gap above the chord of a hinge in its place, shape (T, 3, H) [-].
        slack: Half of that gap, 0 for units that stay on one side, shape (T, H) [-].
        second: Units of the second layer before the hinge, of those chords, shape (T, 3, H) [-].
        doubt: How far beyond its hinge a unit of the second layer may come, shape (T, H) [-].
        slopes: Energy by the units of the first layer, through those of the second that stay on, shape (T, H) [nats].
        energies: Energy of those that stay on, of those chords, shape (T, 3) [nats].
    """

    offsets: Tensor
    first: Tensor
    chords: Tensor
    slack: Tensor
    second: Tensor
    doubt: Tensor
    slopes: Tensor
    energies: Tensor

    def of(self, tiles: Int[Tensor, " G"]) -> "Outline":
        """The same of some of the tiles."""
        return Outline(*(part.index_select(0, tiles) for part in self))


class GridScorer:
    """E(x, y) of some observations x for all y of a square grid, on a CPU and in float32.

    Args:
        head: The energy; its weights are read now.
        features: One vector an observation, shape (B, F) [-].
        num_threads: Threads that share out the tiles; those that torch may use if None.
    """

    @torch.no_grad()
    def __init__(
        self, head: EnergyHead, features: Float[Tensor, "B F"], *, num_threads: int | None = None
    ) -> None:
        observation_weight, action_weight = head.first.weight.split(
            [features.shape[1], ACTION_SIZE], dim=1
        )
        self._by_action = action_weight.t().contiguous()  # (2, H)
        self._second, self._bias, self._last = head.second.weight, head.second.bias, head.last
        self._sizes = self._second.abs()
        with one_thread() as available:
            self._observed = F.linear(features, observation_weight, head.first.bias)  # (B, H)
        self._num_threads = num_threads or available

    @torch.no_grad()
    def __call__(self, candidates: Float[Tensor, "1 N 2"]) -> Float[Tensor, "B N"]:
        """Score a grid.

        Args:
            candidates: All pairs of evenly spaced accelerations and steerings, acceleration outermost, as
                `action_grid` makes them [-].

        Returns:
            Energies [nats].
        """
        points = math.isqrt(candidates.shape[1])
        assert candidates.shape == (1, points**2, 2), "a square grid that observations share"
        num_tiles = max(1, round(points / ACTIONS_ALONG_A_SIDE))
        side = 2 * math.ceil(points / (2 * num_tiles))  # even, to be cut in four
        num_tiles = math.ceil(points / side)
        # Behind its end the last action of a row is repeated.
        places = torch.arange(num_tiles * side).clamp_(max=points - 1)
        grid = candidates.view(points, points, 2).index_select(0, places).index_select(1, places)
        tiles = grid.view(num_tiles, side, num_tiles, side, 2).transpose(1, 2).flatten(0, 1)
        energies = tiles.new_empty(len(self._observed), len(tiles), side, side)
        # Neighbouring tiles cost alike, so each piece has some of all regions.
        num_pieces = math.ceil(len(tiles) / TILES_AT_A_TIME)
        pieces = [
            (observed, tiles[start::num_pieces], scores[start::num_pieces])
            for observed, scores in zip(self._observed, energies, strict=True)
            for start in range(num_pieces)
        ]
        with one_thread():
            for_each(pieces, lambda: self._score, num_threads=self._num_threads)
        rows = energies.unflatten(1, (num_tiles, num_tiles)).transpose(2, 3)
        return rows.flatten(3, 4).flatten(1, 2)[:, :points, :points].flatten(1)

    def _score(self, piece: tuple[Tensor, Tensor, Tensor]) -> None:
        """Write the energies (T, S, S) of tiles (T, S, S, 2) for an observation (H)."""
        observed, tiles, energies = piece
        side = tiles.shape[1]
        outline = self._outline(observed, tiles)
        counts = torch.stack(((outline.slack > 0).sum(1), (outline.doubt > 0).sum(1)), dim=1)
        products = (counts + 3).prod(1)
        order = products.argsort(descending=True, stable=True)
        begin = 0
        if side % 2 == 0:
            begin = int((products * side**2 > MOST_PRODUCTS).sum())
        if begin > 0:
            quarters = _quarters(tiles[order[:begin]])
            scores = quarters.new_empty(quarters.shape[:3])
            self._score((observed, quarters, scores))
            energies[order[:begin]] = _joined(scores)
        numbers = counts[order].tolist()
        while begin < len(order):
            numbers_each = (sum(numbers[begin]) + 6) * side**2
            end = begin + max(1, NUMBERS_AT_A_TIME // numbers_each)
            num_first, num_second = (
                max(1, *column) for column in zip(*numbers[begin:end], strict=True)
            )
            group = order[begin:end]
            scores = self._energies(outline.of(group), num_first, num_second)
            energies[group] = scores.view(-1, side, side)
            begin = end

    def _outline(self, observed: Tensor, tiles: Tensor) -> Outline:
        """What is known of tiles (T, S, S, 2) for an observation (H)."""
        one_end, other_end = tiles[:, 0, 0], tiles[:, -1, -1]
        centre, reach = (one_end + other_end) / 2, (other_end - one_end) / 2  # (T, 2)
        offsets = tiles.new_ones(len(tiles), 3, tiles.shape[1] ** 2)
        torch.sub(tiles.flatten(1, 2).transpose(1, 2), centre[:, :, None], out=offsets[:, 1:])
        first = tiles.new_empty(len(tiles), 3, HIDDEN_SIZE)
        first[:, 0] = torch.addmm(observed, centre, self._by_action)
        first[:, 1:] = self._by_action
        swing = reach @ self._by_action.abs()  # (T, H)
        chord = ((first[:, 0] + swing) / (2 * swing).clamp_(min=SMALLEST)).clamp_(0, 1)
        slack = (swing - first[:, 0]).mul_(chord).clamp_(min=0).mul_(0.5)
        chords = first * chord[:, None]
        chords[:, 0] += slack
        second = (chords.flatten(0, 1) @ self._second.t()).view_as(chords)
        second[:, 0] += self._bias
        spread = slack @ self._sizes.t()
        spread += (second[:, 1:].abs() * reach[:, :, None]).sum(1)
        staying = (second[:, 0] >= spread) * self._last.weight  # (T, H)
        return Outline(
            offsets,
            first,
            chords,
            slack,
            second,
            doubt=spread - second[:, 0].abs(),
            slopes=staying @ self._second,
            energies=(second * staying[:, None]).sum(2),
        )

    def _energies(self, tiles: Outline, num_first: int, num_second: int) -> Float[Tensor, "T P"]:
        """Energies of the actions of tiles, with this many units of each layer action by action."""
        doubt, second = tiles.doubt.topk(num_second, sorted=False)  # (T, M)
        first = tiles.slack.topk(num_first, sorted=False).indices  # (T, K)
        each, thrice = first[:, None].expand(-1, 3, -1), second[:, None].expand(-1, 3, -1)
        # What M units of the second layer, and behind them the energy, take from each of K units of the first, and from
        # the offsets. Tiles have different numbers of such units: some of K and M stay on one side and change nothing.
        weights = tiles.slack.new_empty(len(first), num_first, num_second + 1)
        entries = torch.add(first[:, :, None], second[:, None], alpha=HIDDEN_SIZE)  # (T, K, M)
        weights[:, :, :-1] = self._second.view(-1).take(entries)
        weights[:, :, -1] = tiles.slopes.gather(1, first)
        lines = torch.cat((tiles.second.gather(2, thrice), tiles.energies[:, :, None]), dim=2)
        lines.baddbmm_(tiles.chords.gather(2, each), weights, alpha=-1)  # (T, 3, M + 1)
        hidden = torch.bmm(tiles.first.gather(2, each).transpose(1, 2), tiles.offsets)  # (T, K, P)
        found = torch.bmm(lines.transpose(1, 2), tiles.offsets)  # (T, M + 1, P)
        found.baddbmm_(weights.transpose(1, 2), hidden.clamp_(min=0))
        found[:, :-1].clamp_(min=0)
        last = hidden.new_ones(len(first), 1, num_second + 1)
        torch.mul(self._last.weight.view(-1).take(second), doubt > 0, out=last[:, 0, :-1])
        return torch.bmm(last, found).squeeze(1).add_(self._last.bias)


def _quarters(tiles: Float[Tensor, "T S S 2"]) -> Float[Tensor, "U R R 2"]:
    """Cut each tile in four."""
    half = tiles.shape[1] // 2
    return tiles.view(-1, 2, half, 2, half, 2).transpose(2, 3).reshape(-1, half, half, 2)


def _joined(quarters: Float[Tensor, "U R R"]) -> Float[Tensor, "T S S"]:
    """Put quarters of tiles together again."""
    half = quarters.shape[1]
    return quarters.view(-1, 2, 2, half, half).transpose(2, 3).reshape(-1, 2 * half, 2 * half)
