"""The model card as a page to read."""

from collections.abc import Iterator, Mapping

from mjdrive.evaluation.spread import FIGURES
from mjdrive.zoo.cards import Evaluation, ModelCard, Training
from mjdrive.zoo.entries import PREFIX
from mjdrive.zoo.reference import TOLERANCE

MOST_EPOCHS = 8
"""Epochs whose loss is shown, the last among them [-]."""

_WORDS = {
    "bc-beta": "explicit: one Beta distribution over each action",
    "bc-mixture": "explicit: a mixture of Beta distributions",
    "bc-grid": "explicit: a categorical distribution over a grid of actions",
    "ibc": "implicit: an energy, trained against uniform negatives",
    "da-ibc": "implicit: an energy, trained against disturbed expert actions",
    "ibc-langevin": "implicit: an energy, trained against the ends of Langevin chains",
    "diffusion": "generative: noise is turned into an action by a denoiser",
    "flow": "generative: noise flows to an action along a learnt field",
}


def to_page(card: ModelCard) -> str:
    """Write a card as Markdown."""
    return "\n".join(_lines(card)) + "\n"


def _lines(card: ModelCard) -> Iterator[str]:
    yield f"# {PREFIX}{card.name}"
    yield ""
    yield f"Method `{card.method}`, {_WORDS[card.method]}. Made by `scripts/ship_policy.py`; `card.json` has every figure, `config.json` every setting."
    yield ""
    yield "```"
    yield f"mjdrive drive --policy {PREFIX}{card.name} --town town02 --steps 3000"
    yield "```"
    yield ""
    yield "## How it drives"
    yield ""
    if not card.evaluations:
        yield "Not measured yet."
    for evaluation in card.evaluations:
        yield from _evaluation(evaluation, card)
    yield ""
    yield "## How it was made"
    yield ""
    yield from _training(card.training)
    yield ""
    yield from _table(_facts(card))
    yield ""
    yield "## How to check it"
    yield ""
    yield from _reference(card)


def _evaluation(evaluation: Evaluation, card: ModelCard) -> Iterator[str]:
    """Figures of one evaluation beside the command that makes them."""
    summary = evaluation.summary
    count = f"{summary.episodes} drive{'' if summary.episodes == 1 else 's'}"
    yield f"{count} of {evaluation.steps:,} steps in {summary.town} (car: {summary.car}); mean ± standard deviation over the drives:"
    yield ""
    yield from _table(
        {title: str(summary.figures[name]) for name, title in FIGURES.items()}
        | {
            "clean drives": f"{summary.clean} of {summary.episodes}",
            "branches, all drives": f"{len(summary.branches_taken)} of {summary.branches}",
        }
    )
    yield ""
    yield "```"
    yield evaluation.command
    yield "```"
    if evaluation.weights_sha256 != card.weights.sha256:
        yield ""
        if card.weights.number_format == "float32":
            yield "These drives were made with all expert actions of the training; a policy that does not search makes the same ones without."
        else:
            yield "These drives were made by the weights as training left them, in float32, before they were rounded: the command above makes others."


def _training(training: Training) -> Iterator[str]:
    """Commands, and the losses of the epochs."""
    yield "```"
    yield from training.commands
    yield "```"
    yield ""
    if len(training.losses) < training.epochs:
        yield f"The weights are those after epoch {len(training.losses)} of {training.epochs}."
        yield ""
    step = max(1, -(-len(training.losses) // MOST_EPOCHS))
    shown = [*range(0, len(training.losses) - 1, step), len(training.losses) - 1]
    yield "| epoch | " + " | ".join(str(epoch + 1) for epoch in shown) + " |"
    yield "|" + "---|" * (len(shown) + 1)
    yield "| loss [nats] | " + " | ".join(f"{training.losses[it]:.3f}" for it in shown) + " |"
    if training.validation_losses:
        held_out = " | ".join(f"{training.validation_losses[it]:.3f}" for it in shown)
        yield f"| of the pairs held out [nats] | {held_out} |"


def _facts(card: ModelCard) -> dict[str, str]:
    """Digests, sizes and versions."""
    weights, source = card.weights, card.source
    kept = weights.expert_actions
    starts = (
        {}
        if not kept
        else {
            "expert actions kept": f"{kept:,}; the search of the paper (`--preset paper`) starts from them, where that of training started from all"
        }
    )
    return {
        "demonstrations": f"{source.num_demonstrations:,} pairs in {source.town}, manifest `{source.manifest_sha256[:16]}`",
        "cars of the demonstrations": ", ".join(sorted(set(source.cars.values()))),
        "training seed": str(card.training.seed),
        "training": f"{card.training.duration_s / 60:.0f} min",
        "versions": ", ".join(f"{name} {version}" for name, version in source.versions.items()),
        "weights": f"{weights.number_format}, SHA-256 `{weights.sha256[:16]}`",
        "rounding from float32": (
            f"total variation of the chosen actions at most {weights.largest_variation:.4f}, "
            f"{weights.mean_variation:.4f} on average, over {weights.observations} observations"
            if weights.number_format != "float32"
            else "none"
        ),
        **starts,
    }


def _reference(card: ModelCard) -> Iterator[str]:
    drive = card.reference
    yield f"{drive.steps} steps in {drive.town} with seed {drive.seed}, on the CPU, energies in float32: {drive.distance_m:.1f} m to ({drive.end_x:.2f}, {drive.end_y:.2f}), actions `{drive.actions_sha256[:16]}`."
    yield f"The actions are the same bit for bit with the same versions ({', '.join(f'{name} {version}' for name, version in drive.versions.items())}) on a machine that"
    yield f"rounds alike; on others distance and end are within {TOLERANCE:g} m. `tests/contract/test_zoo.py` makes the drive again."


def _table(rows: Mapping[str, str]) -> Iterator[str]:
    yield "| | |"
    yield "|---|---|"
    for name, value in rows.items():
        yield f"| {name} | {value} |"
