"""Training into a run folder: what is written after each epoch, and how it is taken up again."""

from pathlib import Path

import torch

from models import checkpoint
from models.errors import CheckpointError
from models.interfaces import Learner
from models.progress import EpochReport, from_lines, to_lines
from models.training_state import TrainingState


def require_free(folder: Path) -> None:
    """Refuse to begin where a run is.

    Raises:
        CheckpointError: If the folder holds one.
    """
    if (folder / checkpoint.STATE).exists():
        raise CheckpointError(
            f"'{folder}' holds a training run already. Resume it, or train into another folder."
        )


def save(
    folder: Path, learner: Learner, state: TrainingState, history: list[EpochReport], *, seed: int
) -> None:
    """Write the checkpoint of a complete epoch; what is resumed from comes last but for the label.

    Args:
        folder: Run folder; made if missing.
        learner: What is trained.
        state: Weights, moments and means.
        history: One report a complete epoch.
        seed: Seed of the run.
    """
    config, epoch = learner.config, len(history)
    label = checkpoint.RunState(config.method, seed, epoch, config.optimiser.epochs)
    folder.mkdir(parents=True, exist_ok=True)
    checkpoint.write_atomically(folder / checkpoint.METRICS, to_lines(history).encode())
    checkpoint.write_tensors(folder / checkpoint.TRAINING, state.tensors(), epoch=epoch)
    with state.weights_to_act():
        checkpoint.save(folder, learner, label)


def take_up(
    folder: Path, learner: Learner, state: TrainingState, *, seed: int, device: torch.device
) -> list[EpochReport]:
    """Put a learner where the last complete epoch of a run left it.

    Args:
        folder: Run folder.
        learner: Untrained, with the settings of the run.
        state: Its weights, moments and means.
        seed: Seed of the run.
        device: Where the tensors go.

    Returns:
        One report a complete epoch.

    Raises:
        CheckpointError: If the folder holds no run, one with other settings or another seed, or a damaged one.
    """
    tensors, epoch = checkpoint.read_tensors(folder / checkpoint.TRAINING, device=device)
    if checkpoint.load_config(folder) != learner.config:
        raise CheckpointError(f"'{folder}' was trained with other settings; resume with its own.")
    if (trained := checkpoint.load_state(folder).seed) != seed:
        raise CheckpointError(f"'{folder}' was trained with seed {trained}, not {seed}.")
    state.restore(tensors)
    return read_history(folder / checkpoint.METRICS, epoch)


def read_history(path: Path, epoch: int) -> list[EpochReport]:
    """Read the reports of the complete epochs of a run."""
    try:
        history = from_lines(path.read_text())[:epoch]
    except (OSError, ValueError, TypeError) as error:
        raise CheckpointError(
            f"Cannot read '{path}': {error}. Expected one line of JSON an epoch; train again."
        ) from error
    if len(history) != epoch:
        raise CheckpointError(
            f"'{path}' tells of {len(history)} epochs, the checkpoint beside it of {epoch}; train again."
        )
    return history
