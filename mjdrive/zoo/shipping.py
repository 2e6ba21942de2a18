"""A training run -> an entry of the zoo: weights rounded where that changes little, settings, card, page."""

import dataclasses
import shlex
import shutil
from collections.abc import Callable, Iterable
from pathlib import Path

import torch

from mjdrive import config
from mjdrive.config import read_json
from mjdrive.episodes import store
from mjdrive.episodes.driving import drive_expert
from mjdrive.errors import ConfigError, RunError
from mjdrive.files import write_atomically
from mjdrive.learning import runs
from mjdrive.learning.batches import PackedDemonstrations
from mjdrive.learning.settings import acting_changed
from mjdrive.learning.training import Source
from mjdrive.simulation.simulation import Simulation
from mjdrive.zoo.cards import ModelCard, Training, Weights, read_card
from mjdrive.zoo.entries import CARD, PAGE
from mjdrive.zoo.evaluations import read_evaluation
from mjdrive.zoo.page import to_page
from mjdrive.zoo.reference import make_reference
from mjdrive.zoo.training_command import training_command
from models import checkpoint
from models.errors import ModelsError
from models.expert_actions import STORED, thinned
from models.half_precision import halved, variations, widened
from models.interfaces import Batch, Learner
from models.learners import build_learner
from models.run_folder import read_history

LOSSLESS_ENOUGH = 0.01
"""Largest total variation that rounding may cause [-]; bfloat16, in which energies are often scored, causes more."""

MOST_EXPERT_ACTIONS = 2**16
"""That are kept of a policy which can start a search from them; four times as many as the paper's starts from [-]."""

LOOKED_AT = 600
"""Steps of the expert's walk that is looked at [-]."""

EVERY = 6
"""Steps between two observations of it [-]."""

MOST_BYTES = 30_000_000
"""All entries together [B]."""


def ship(
    run: Path,
    zoo: Path,
    *,
    name: str,
    collects: tuple[str, ...],
    data: Path,
    simulation: Simulation,
    acting: Iterable[str] = (),
    evaluations: Iterable[Path] = (),
    on_stage: Callable[[str], None] = lambda stage: None,
) -> ModelCard:
    """Make an entry; one of that name is replaced once the new one is complete.

    Args:
        run: Folder of the training run.
        zoo: Folder of the entries.
        name: Of the entry.
        collects: Commands that made the demonstrations, in order.
        data: Folder that they wrote to.
        simulation: The town that it is tried in; it is reset.
        acting: Changes to the way in which it was trained to act, each as "sampler.grid.choice=argmin".
        evaluations: Folders of its drives.
        on_stage: Told what is done next.

    Returns:
        The card of the entry.

    Raises:
        RunError: If the run is damaged, does not drive, or the entries become too large.
        ConfigError: If the name or a change of the way to act is none.
        DataError: If drives were made by something else.
    """
    _require_name(name)
    on_stage("read the run")
    learner, history = _read(run)
    learner.config = acting_changed(learner.config, acting)
    entry = zoo / f".{name}"
    shutil.rmtree(entry, ignore_errors=True)
    try:
        on_stage("round the weights")
        weights = _write_weights(run, learner, entry, simulation)
        digests = {weights.sha256, weights.trained_sha256}
        on_stage("read the drives")
        read = tuple(
            read_evaluation(folder, name=name, acting=learner.config, digests=digests)
            for folder in evaluations
        )
        on_stage("drive")
        trained = training_command(learner.config, seed=history.seed, data=data)
        card = ModelCard(
            name=name,
            method=learner.config.method,
            weights=weights,
            source=read_json(Source, run / runs.SOURCE),
            training=dataclasses.replace(history, commands=(*collects, trained)),
            reference=make_reference(entry, simulation),
            evaluations=read,
        )
        write_card(card, entry)
        _require_small(entry, zoo, name)
        shutil.rmtree(zoo / name, ignore_errors=True)
        entry.rename(zoo / name)
    finally:
        shutil.rmtree(entry, ignore_errors=True)
    return card


def refresh(entry: Path, *, simulation: Simulation | None = None) -> ModelCard:
    """Write the card of an entry again, after presets or wording changed.

    Args:
        entry: Its folder.
        simulation: Where its reference drive is made again, after the physics changed; it is kept if None.

    Returns:
        The new card.

    Raises:
        ConfigError: If it has no card.
        RunError: If it cannot be loaded, or does not drive any more.
    """
    card = read_card(entry)
    *collects, trained = card.training.commands
    words = shlex.split(trained)
    command = training_command(
        checkpoint.load_config(entry),
        seed=card.training.seed,
        data=Path(words[words.index("--data") + 1]),
    )
    card = dataclasses.replace(
        card,
        training=dataclasses.replace(card.training, commands=(*collects, command)),
        reference=card.reference if simulation is None else make_reference(entry, simulation),
    )
    write_card(card, entry)
    return card


def write_card(card: ModelCard, entry: Path) -> None:
    """Write a card, for programs and for people."""
    config.write_json(card, entry / CARD)
    write_atomically(entry / PAGE, to_page(card).encode())


def _require_name(name: str) -> None:
    if not name.isascii() or not name.replace("-", "").isalnum() or name != name.lower():
        raise ConfigError(
            f"Cannot call a shipped policy '{name}'. Expected small letters, digits and hyphens, as in da-ibc."
        )


def _read(run: Path) -> tuple[Learner, Training]:
    """Read a run, and how its training went, but for the commands."""
    try:
        learner, state = checkpoint.load(run), checkpoint.load_state(run)
        # Checkpoints that a study keeps of earlier epochs lie two folders below the history of the run.
        place = next(
            (it for it in (run, run.parent.parent) if (it / checkpoint.METRICS).is_file()), run
        )
        history = read_history(place / checkpoint.METRICS, state.epoch)
    except ModelsError as error:
        raise RunError(str(error)) from error
    held_out = [it.validation_loss for it in history if it.validation_loss is not None]
    return learner, Training(
        commands=(),
        seed=state.seed,
        epochs=state.epochs,
        losses=tuple(round(report.loss, 4) for report in history),
        validation_losses=tuple(round(loss, 4) for loss in held_out),
        duration_s=round(sum(report.duration_s for report in history)),
    )


def _write_weights(run: Path, learner: Learner, entry: Path, simulation: Simulation) -> Weights:
    """Write all that acts, with rounded weights if that changes little."""
    state = checkpoint.load_state(run)
    kept = thinned(learner.state_dict(), MOST_EXPERT_ACTIONS)
    halves = halved(kept)
    moments = _moments(simulation)
    changes = torch.ones(1) if halves is None else _changes(learner, halves, moments)
    is_enough = halves is not None and float(changes.max()) <= LOSSLESS_ENOUGH
    checkpoint.save(entry, learner, state)
    written = halves if is_enough and halves is not None else kept
    checkpoint.write_tensors(entry / checkpoint.MODEL, written, epoch=state.epoch)
    shutil.copyfile(run / runs.SOURCE, entry / runs.SOURCE)
    return Weights(
        number_format="float16" if is_enough else "float32",
        sha256=store.digest((entry / checkpoint.MODEL).read_bytes()),
        trained_sha256=store.digest((run / checkpoint.MODEL).read_bytes()),
        largest_variation=round(float(changes.max()), 6) if is_enough else 0.0,
        mean_variation=round(float(changes.mean()), 6) if is_enough else 0.0,
        observations=len(moments.state),
        expert_actions=len(kept.get(STORED[0], ())),
    )


def _changes(learner: Learner, halves: dict[str, torch.Tensor], moments: Batch) -> torch.Tensor:
    """How much rounding changes what is chosen at each moment (B) [-]."""
    rounded = build_learner(learner.config, seed=0)
    rounded.load_state_dict(widened(halves))
    return variations(learner, rounded.eval(), moments.bev, moments.state)


def _moments(simulation: Simulation) -> Batch:
    """What is seen on a walk of the expert, in a town that policies have not learnt from."""
    episode = drive_expert(simulation, num_steps=LOOKED_AT, seed=0)
    seen = PackedDemonstrations([episode], simulation.town)
    return seen.batch(torch.arange(0, LOOKED_AT, EVERY))


def _require_small(entry: Path, zoo: Path, name: str) -> None:
    """Refuse an entry that makes the wheel too large."""
    others = [folder for folder in zoo.glob("[!.]*") if folder.is_dir() and folder.name != name]
    total = sum(size_of(folder) for folder in (entry, *others))
    if total > MOST_BYTES:
        raise RunError(
            f"With '{name}' the shipped policies take {total / 1e6:.1f} MB; expected at most {MOST_BYTES / 1e6:g} MB. "
            f"Remove another one from '{zoo}' first."
        )


def size_of(folder: Path) -> int:
    """Bytes of all files of a folder [B]."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
