"""Fit a learner to demonstrations: minibatches, Adam, a checkpoint after each epoch, and an exact way to go on."""

import math
import time
from collections.abc import Callable
from pathlib import Path

import torch
from torch import Tensor

from models import checkpoint
from models.config import LearnerConfig, OptimiserConfig
from models.density import action_density, inverse_weights
from models.errors import CheckpointError, TrainingError
from models.interfaces import Demonstrations, Learner
from models.progress import EpochReport, StepReport, from_lines, to_lines
from models.samplers.draws import draw_categorical
from models.schedule import learning_rate
from models.training_state import TrainingState


def fit(
    learner: Learner,
    demonstrations: Demonstrations,
    config: LearnerConfig,
    *,
    folder: Path | None = None,
    seed: int = 0,
    resume: bool = False,
    on_epoch: Callable[[EpochReport], None] | None = None,
    on_step: Callable[[StepReport], None] | None = None,
    device: torch.device | str = "cpu",
) -> list[EpochReport]:
    """Train a learner; with the same seed and number of threads, to the same weights.

    Args:
        learner: What to train, in place; it ends on `device` with the weights to act with.
        demonstrations: What to learn from.
        config: Settings, those that the learner was built with.
        folder: Run folder to write a checkpoint to after each epoch, or None to write nothing.
        seed: Seed of order, negatives and dropout.
        resume: Whether to go on from the last complete epoch in `folder`.
        on_epoch: Called after each epoch, when its checkpoint is complete.
        on_step: Called after each step.
        device: Where to train.

    Returns:
        One report an epoch, those before a resumption included.

    Raises:
        CheckpointError: If there is nothing to resume from, other settings were used before, or the folder
            holds another run that is not to be resumed.
        TrainingError: If there are no demonstrations, or the loss is no longer finite.
    """
    assert learner.config == config, "the learner was built with other settings"
    run = _Run(learner, demonstrations, seed=seed, device=torch.device(device))
    history: list[EpochReport] = []
    if resume:
        history = run.resume(folder)
        assert folder is not None, "resume() refuses it"
        run.save(folder, history)  # an interruption may have come between the files of a checkpoint
    elif folder is not None and (folder / checkpoint.STATE).exists():
        raise CheckpointError(
            f"'{folder}' holds a training run already. Resume it, or train into another folder."
        )
    for epoch in range(len(history), config.optimiser.epochs):
        history.append(run.train_epoch(epoch, on_step))
        if folder is not None:
            run.save(folder, history)
        if on_epoch is not None:
            on_epoch(history[-1])
    run.state.put_weights_to_act()
    learner.eval()
    return history


def epoch_seed(seed: int, epoch: int, stream: int) -> int:
    """Seed of one stream of chance in one epoch, so that no generator state has to be saved."""
    return ((seed * 1_000_003 + epoch) * 2 + stream) % 2**63


class _Run:
    """One call of `fit`: the learner, the data and the optimiser together."""

    def __init__(
        self, learner: Learner, demonstrations: Demonstrations, *, seed: int, device: torch.device
    ) -> None:
        self.settings: OptimiserConfig = learner.config.optimiser
        self.learner = learner
        self.demonstrations = demonstrations
        self.seed = seed
        self.device = device
        share = self.settings.validation_share
        self.num_training = len(demonstrations) - math.floor(share * len(demonstrations))
        if self.num_training == 0:
            raise TrainingError("There are no demonstrations to train on. Collect some first.")
        actions = demonstrations.actions[: self.num_training].to(device)
        density = action_density(actions, learner.config.density)
        self.weights = inverse_weights(density, learner.config.density).cpu()
        learner.prepare(actions, density)
        learner.to(device).train()
        self.state = TrainingState(learner, self.settings)
        self.steps_per_epoch = math.ceil(self.num_training / self.settings.batch_size)

    def train_epoch(self, epoch: int, on_step: Callable[[StepReport], None] | None) -> EpochReport:
        """Descend on every minibatch of one pass."""
        started = time.perf_counter()
        generator = torch.Generator(self.device).manual_seed(epoch_seed(self.seed, epoch, 0))
        num_steps = self.settings.epochs * self.steps_per_epoch
        losses, norms, rate = [], [], 0.0
        batches = self._order(epoch).split(self.settings.batch_size)
        for step, indices in enumerate(batches, start=epoch * self.steps_per_epoch):
            rate = learning_rate(step, num_steps, self.settings)
            loss = self._loss(indices, generator, weighted=True)
            if not math.isfinite(loss.item()):
                raise TrainingError(
                    f"The loss is {loss.item()} at step {step} of epoch {epoch + 1}. "
                    f"Lower optimiser.learning_rate (now {self.settings.learning_rate})."
                )
            norms.append(self.state.descend(loss, rate))
            losses.append(loss.item())
            if on_step is not None:
                on_step(StepReport(step + 1, num_steps, losses[-1]))
        duration_s = time.perf_counter() - started
        return EpochReport(
            epoch=epoch + 1,
            loss=sum(losses) / len(losses),
            validation_loss=self._validation_loss(epoch),
            learning_rate=rate,
            gradient_norm=sum(norms) / len(norms),
            duration_s=duration_s,
            samples_per_s=self.num_training / duration_s,
        )

    def _order(self, epoch: int) -> Tensor:
        """Indices of the pairs of one epoch: each once, or drawn by weight with replacement."""
        generator = torch.Generator().manual_seed(epoch_seed(self.seed, epoch, 1))
        if self.learner.config.density.weighting != "sampler":
            return torch.randperm(self.num_training, generator=generator)
        return draw_categorical(self.weights[None], self.num_training, generator=generator)[0]

    def _loss(self, indices: Tensor, generator: torch.Generator, *, weighted: bool) -> Tensor:
        batch = self.demonstrations.batch(indices).to(self.device)
        chance = self.learner.draw(batch.actions, generator=generator)
        weights = None
        if weighted and self.learner.config.density.weighting == "loss":
            weights = self.weights[indices].to(self.device)
        bfloat16 = self.settings.precision == "bfloat16"
        with torch.autocast(self.device.type, torch.bfloat16, enabled=bfloat16):
            return self.learner.loss(batch, chance, weights=weights)

    @torch.no_grad()
    def _validation_loss(self, epoch: int) -> float | None:
        held_out = torch.arange(self.num_training, len(self.demonstrations))
        if len(held_out) == 0:
            return None
        generator = torch.Generator(self.device).manual_seed(epoch_seed(self.seed, epoch, 0))
        total = 0.0
        for indices in held_out.split(self.settings.batch_size):
            total += self._loss(indices, generator, weighted=False).item() * len(indices)
        return total / len(held_out)

    def save(self, folder: Path, history: list[EpochReport]) -> None:
        """Write the checkpoint of a complete epoch; what is resumed from comes last but for the label."""
        config, epoch = self.learner.config, len(history)
        state = checkpoint.RunState(config.method, self.seed, epoch, self.settings.epochs)
        folder.mkdir(parents=True, exist_ok=True)
        checkpoint.write_atomically(folder / checkpoint.METRICS, to_lines(history).encode())
        checkpoint.write_tensors(folder / checkpoint.TRAINING, self.state.tensors(), epoch=epoch)
        with self.state.weights_to_act():
            checkpoint.save(folder, self.learner, state)

    def resume(self, folder: Path | None) -> list[EpochReport]:
        """Take up the last complete epoch."""
        if folder is None:
            raise CheckpointError(
                "There is no run folder to resume from; give the folder of a run."
            )
        tensors, epoch = checkpoint.read_tensors(folder / checkpoint.TRAINING, device=self.device)
        if checkpoint.load_config(folder) != self.learner.config:
            raise CheckpointError(
                f"'{folder}' was trained with other settings; resume with its own."
            )
        if (seed := checkpoint.load_state(folder).seed) != self.seed:
            raise CheckpointError(f"'{folder}' was trained with seed {seed}, not {self.seed}.")
        self.state.restore(tensors)
        return _read_history(folder / checkpoint.METRICS, epoch)


def _read_history(path: Path, epoch: int) -> list[EpochReport]:
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
