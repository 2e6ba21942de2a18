"""Train in float32 and in bfloat16 from the same seeds, and show both loss curves: `python scripts/compare_precision.py --help`."""

import argparse
import dataclasses
from pathlib import Path

import matplotlib as mpl
import numpy as np
import torch

mpl.use("agg")
from matplotlib import pyplot as plt

from mjdrive.cli.console import progress_bars
from mjdrive.episodes import dataset
from mjdrive.learning.batches import PackedDemonstrations
from mjdrive.learning.settings import learner_settings
from mjdrive.town import library
from models.config import LearnerConfig
from models.learners import build_learner
from models.training import fit

PRECISIONS = ("float32", "bfloat16")
COLOURS = {"float32": "#1f5fa8", "bfloat16": "#d1681f"}
HELD_OUT = 0.2
WINDOW = 5
"""Steps that a curve is averaged over [-]."""


def losses(
    config: LearnerConfig, demonstrations: PackedDemonstrations, *, precision: str, seed: int
) -> tuple[list[float], float]:
    """Train once; the loss of each step, and the one held out after the last epoch [nats]."""
    optimiser = dataclasses.replace(
        config.optimiser, precision=precision, validation_share=HELD_OUT
    )
    config = dataclasses.replace(config, optimiser=optimiser)
    steps: list[float] = []
    history = fit(
        build_learner(config, seed=seed),
        demonstrations,
        config,
        seed=seed,
        on_step=lambda report: steps.append(report.loss),
    )
    held_out = history[-1].validation_loss
    assert held_out is not None, "a share is held out"
    return steps, held_out


def plot(curves: dict[tuple[str, int], list[float]], path: Path) -> None:
    """Draw every curve, and the difference of the two formats beside the difference of two seeds."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.6), layout="constrained")
    smooth = {
        key: np.convolve(values, np.ones(WINDOW) / WINDOW, "valid")
        for key, values in curves.items()
    }
    seeds = sorted({seed for _, seed in curves})
    for (precision, seed), values in smooth.items():
        label = precision if seed == seeds[0] else None
        left.plot(values, color=COLOURS[precision], alpha=0.8, lw=1.2, label=label)
    left.set(
        xlabel="step", ylabel="loss [nats]", title=f"{len(seeds)} seeds, mean of {WINDOW} steps"
    )
    left.legend(frameon=False)
    for index, seed in enumerate(seeds):
        formats = smooth["bfloat16", seed] - smooth["float32", seed]
        others = smooth["float32", seeds[index - 1]] - smooth["float32", seed]
        right.plot(
            others,
            color="0.7",
            lw=1.2,
            label="another seed - this one, float32" if index == 0 else None,
        )
        right.plot(
            formats,
            color=COLOURS["bfloat16"],
            lw=1.2,
            label="bfloat16 - float32, same seed" if index == 0 else None,
        )
    right.set(
        xlabel="step", ylabel="difference [nats]", title="What the format changes, what the seed"
    )
    right.legend(frameon=False)
    for axis in (left, right):
        axis.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(figure)


def main() -> None:
    """Train, print the figures and draw the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=Path("data/town01"))
    parser.add_argument("--method", default="da-ibc")
    parser.add_argument("--epochs", type=int, default=3)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--threads", type=int, default=torch.get_num_threads())
    parser.add_argument("--picture", type=Path, default=Path("precision.png"))
    words = parser.parse_args()
    torch.set_num_threads(words.threads)
    config = learner_settings(
        words.method, preset="quick", assignments=[f"optimiser.epochs={words.epochs}"]
    )
    manifest, episodes = dataset.read_dataset(words.data)
    demonstrations = PackedDemonstrations(episodes, library.load(manifest.town))
    curves, ends = {}, {precision: [] for precision in PRECISIONS}
    with progress_bars() as bars:
        task = bars.add_task("train", total=2 * words.seeds, unit="runs")
        for seed in range(words.seeds):
            for precision in PRECISIONS:
                curves[precision, seed], held_out = losses(
                    config, demonstrations, precision=precision, seed=seed
                )
                ends[precision].append(held_out)
                bars.advance(task)
    for precision, values in ends.items():
        each = ", ".join(f"{value:.3f}" for value in values)
        print(
            f"{precision:9}: held out {np.mean(values):.3f} +- {np.std(values, ddof=1):.3f} nats ({each})"
        )
    plot(curves, words.picture)


if __name__ == "__main__":
    main()
