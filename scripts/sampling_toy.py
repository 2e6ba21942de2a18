"""Sample a fork whose shares are known by every sampler, and draw what each makes of it: `python scripts/sampling_toy.py --help`."""

import argparse
import dataclasses
from collections.abc import Callable, Iterable
from pathlib import Path

import matplotlib as mpl
import torch
from torch import Tensor

mpl.use("agg")
from matplotlib import pyplot as plt

from mjdrive import picture_style
from models.config import DfoConfig, GridConfig, LangevinConfig
from models.samplers import dfo, grid, langevin

STEERING, SPREAD, FLOOR = 0.4, 0.08, 1e-4
SHARES = (0.55, 0.65, 0.80)
"""Of the left mode [-]."""

PAPER = DfoConfig(num_samples=4096, start="uniform")
CHAINS = LangevinConfig(num_chains=64)
BATCH = 25
COLOURS = {"left": "#1f5fa8", "right": "#d1681f", "elsewhere": "0.8"}

Sampler = Callable[["Fork", torch.Generator], Tensor]


class Fork:
    """Two Gaussian modes on a low floor, for a batch of observations alike."""

    def __init__(self, share: float) -> None:
        self._share = share

    def density(self, actions: Tensor) -> Tensor:
        """Density of actions (..., 2), not normalised [-]."""
        masses = (STEERING, self._share), (-STEERING, 1 - self._share)
        modes = [
            mass
            * torch.exp(
                -0.5 * (actions - actions.new_tensor([0, place])).square().sum(dim=-1) / SPREAD**2
            )
            for place, mass in masses
        ]
        return sum(modes, torch.full_like(modes[0], FLOOR))

    def energy(self, actions: Tensor) -> Tensor:
        """Energies of actions (A, N, 2) for each observation [nats]."""
        return -self.density(actions).log().expand(BATCH, -1)

    def slopes(self, actions: Tensor) -> Tensor:
        """Slopes of the energy along both components [nats]."""
        with torch.enable_grad():
            actions = actions.detach().requires_grad_()
            return torch.autograd.grad(self.energy(actions).sum(), actions)[0]


def by_search(**changes: object) -> Sampler:
    """Derivative-free search with changes to the paper's."""
    config = dataclasses.replace(PAPER, **changes)

    def sample(fork: Fork, generator: torch.Generator) -> Tensor:
        start = 2 * torch.rand(BATCH, config.num_samples, 2, generator=generator) - 1
        return dfo.search(fork.energy, start, config, generator=generator).actions

    return sample


def by_chains(**changes: object) -> Sampler:
    """Langevin chains with changes to the published ones."""
    config = dataclasses.replace(CHAINS, **changes)

    def sample(fork: Fork, generator: torch.Generator) -> Tensor:
        start = 2 * torch.rand(BATCH, config.num_chains, 2, generator=generator) - 1
        return langevin.search(fork.energy, fork.slopes, start, config, generator=generator)

    return sample


SAMPLERS: dict[str, Sampler] = {
    "exact grid, 128 x 128": lambda fork, generator: grid.choose(
        fork.energy, GridConfig(points=128), generator=generator
    ),
    "DFO, tempered": by_search(temper=True),
    "DFO, 2 passes": by_search(iterations=2),
    "DFO as the paper, 5 passes": by_search(),
    "DFO, lowest": by_search(choice="argmin"),
    "Langevin, an end by its energy": by_chains(choice="sample"),
    "Langevin, any end": by_chains(choice="chain"),
    "Langevin, lowest end": by_chains(choice="argmin"),
}


def shares(actions: Tensor) -> dict[str, float]:
    """How many of the actions lie in which mode [-]."""
    in_a_mode = (actions[:, 0].abs() < 4 * SPREAD) & (
        (actions[:, 1].abs() - STEERING).abs() < 4 * SPREAD
    )
    left = in_a_mode & (actions[:, 1] > 0)
    found = {"left": left, "right": in_a_mode & ~left, "elsewhere": ~in_a_mode}
    return {name: float(those.float().mean()) for name, those in found.items()}


def sampled(share: float, sample: Sampler, num_draws: int) -> dict[str, float]:
    """Shares of what a sampler draws."""
    generator = torch.Generator().manual_seed(0)
    batches = range(0, num_draws, BATCH)
    return shares(torch.cat([sample(Fork(share), generator) for _ in batches]))


def draw(table: dict[float, dict[str, dict[str, float]]], path: Path) -> None:
    """One panel a true share, one bar a sampler."""
    with plt.rc_context(picture_style.STYLE):
        figure, axes = plt.subplots(
            1, len(table), figsize=(11, 3.6), sharey=True, layout="constrained"
        )
        for axis, (share, rows) in zip(axes, table.items(), strict=True):
            beginning = [0.0] * len(rows)
            for name, colour in COLOURS.items():
                widths = [row[name] for row in rows.values()]
                axis.barh(list(rows), widths, left=beginning, color=colour, label=name, height=0.7)
                beginning = [sum(pair) for pair in zip(beginning, widths, strict=True)]
            for place, row in enumerate(rows.values()):
                axis.text(0.02, place, f"{row['left']:.2f}", va="center", color="white")
            axis.axvline(share, color="black", ls="--", lw=1.2)
            axis.set(title=f"left has {share:.2f}", xlim=(0, 1), xlabel="share of the draws [-]")
        axes[0].invert_yaxis()
        figure.legend(
            *axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3, frameon=False
        )
        picture_style.save(figure, path)
        plt.close(figure)


def main(words: Iterable[str] | None = None) -> None:
    """Sample, print the table and draw the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=200, help="of each sampler")
    parser.add_argument("--picture", type=Path, default=Path("sampling.png"))
    options = parser.parse_args(None if words is None else list(words))
    table: dict[float, dict[str, dict[str, float]]] = {}
    for share in SHARES:
        rows = table[share] = {}
        for name, sample in SAMPLERS.items():
            rows[name] = sampled(share, sample, options.draws)
            found = ", ".join(f"{where} {value:.3f}" for where, value in rows[name].items())
            print(f"left has {share:.2f}: {name:32} {found}", flush=True)
    draw(table, options.picture)


if __name__ == "__main__":
    main()
