"""Fit a learner to demonstrations: minibatches, Adam, a checkpoint after each epoch, and an exact way to go on."""

import math
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import torch
from torch import Tensor

from models import agreement, precision, run_folder
from models.ahead import one_ahead
from models.config import LearnerConfig, OptimiserConfig
from models.density import action_density, inverse_weights
from models.distributed import ALONE, Team, sum_over
from models.epoch_order import EpochOrder, epoch_seed
from models.errors import CheckpointError, TrainingError
from models.interfaces import Batch, Chance, Demonstrations, Learner
from models.progress import EpochReport, StepReport
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
    on_ready: Callable[[], None] | None = None,
    on_epoch: Callable[[EpochReport], None] | None = None,
    on_step: Callable[[StepReport], None] | None = None,
    device: torch.device | str = "cpu",
    team: Team = ALONE,
) -> list[EpochReport]:
    """Train a learner; with the same seed, number of threads and processes, to the same weights.

    Args:
        learner: What to train, in place; it ends on `device` with the weights to act with, and with the number format
            that it was trained in among its settings.
        demonstrations: What to learn from.
        config: Settings, those that the learner was built with.
        folder: Run folder to write a checkpoint to after each epoch, or None to write nothing.
        seed: Seed of order, negatives and dropout.
        resume: Whether to go on from the last complete epoch in `folder`.
        on_ready: Called once, when nothing but the first step is left to go wrong; it may empty `folder`.
        on_epoch: Called after each epoch, when its checkpoint is complete.
        on_step: Called after each step.
        device: Where to train.
        team: The processes that share each minibatch, inside `distributed.joined`; the first one writes.

    Returns:
        One report an epoch, those before a resumption included.

    Raises:
        CheckpointError: If there is nothing to resume from, other settings were used before, or the folder
            holds another run that is not to be resumed.
        TrainingError: If there are no demonstrations, fewer pairs a step than processes, or the loss is no longer finite.
        HardwareError: If the processes are about to train different things, or one of them is lost.
    """
    assert learner.config == config, "the learner was built with other settings"
    if resume and folder is None:
        raise CheckpointError("There is no run folder to resume from; give the folder of a run.")
    learner.config = precision.settle(config, device=device, run=folder if resume else None)
    run = _Run(learner, demonstrations, seed=seed, device=torch.device(device), team=team)
    history: list[EpochReport] = []
    writes = folder if team.leads else None
    if resume and folder is not None:
        history = run_folder.take_up(folder, learner, run.state, seed=seed, device=run.device)
    agreement.require_same(
        team,
        agreement.facts(
            learner.config,
            seed=seed,
            actions=run.actions,
            states=demonstrations.states,
            num_epochs_done=len(history),
        ),
    )
    if on_ready is not None:
        on_ready()
    if (
        resume and writes is not None
    ):  # an interruption may have come between the files of a checkpoint
        run_folder.save(writes, learner, run.state, history, seed=seed)
    elif writes is not None:
        run_folder.require_free(writes)
    for epoch in range(len(history), config.optimiser.epochs):
        history.append(run.train_epoch(epoch, on_step))
        if writes is not None:
            run_folder.save(writes, learner, run.state, history, seed=seed)
        if on_epoch is not None:
            on_epoch(history[-1])
    run.state.put_weights_to_act()
    learner.eval()
    return history


class _Minibatch(NamedTuple):
    """What one process takes of a minibatch.

    Attributes:
        batch: Observations and expert actions; may be empty.
        chance: What chance decides about them.
        weights: Factor on the loss of each pair [-], or None.
        share: Of the pairs of the whole minibatch [-].
    """

    batch: Batch
    chance: Chance
    weights: Tensor | None
    share: float


class _Run:
    """One call of `fit`: the learner, the data and the optimiser together."""

    def __init__(
        self,
        learner: Learner,
        demonstrations: Demonstrations,
        *,
        seed: int,
        device: torch.device,
        team: Team,
    ) -> None:
        self.settings: OptimiserConfig = learner.config.optimiser
        agreement.require_shares(team, self.settings.batch_size)
        self.learner = learner
        self.demonstrations = demonstrations
        self.seed = seed
        self.device = device
        self.team = team
        share = self.settings.validation_share
        self.num_training = len(demonstrations) - math.floor(share * len(demonstrations))
        if self.num_training == 0:
            raise TrainingError("There are no demonstrations to train on. Collect some first.")
        self.actions = demonstrations.actions.to(device)
        actions = self.actions[: self.num_training]
        density = action_density(actions, learner.config.density)
        self.weights = inverse_weights(density, learner.config.density).cpu()
        speeds = demonstrations.states[: self.num_training, 0].cpu()
        self.order = EpochOrder(learner.config, seed, speeds, self.weights)
        learner.prepare(actions, density)
        learner.to(device).train()
        self.state = TrainingState(learner, self.settings)
        self.steps_per_epoch = self.settings.steps_per_epoch(self.num_training)

    def train_epoch(self, epoch: int, on_step: Callable[[StepReport], None] | None) -> EpochReport:
        """Descend on every minibatch of one epoch."""
        started = time.perf_counter()
        num_steps = self.settings.epochs * self.steps_per_epoch
        losses, norms, rate = [], [], 0.0
        order = self.order.of(epoch)
        minibatches = one_ahead(self._minibatches(order, epoch, is_training=True))
        for step, minibatch in enumerate(minibatches, start=epoch * self.steps_per_epoch):
            rate = learning_rate(step, num_steps, self.settings)
            loss = self._differentiate(minibatch)
            if not math.isfinite(loss):
                raise TrainingError(
                    f"The loss is {loss} at step {step} of epoch {epoch + 1}. "
                    f"Lower optimiser.learning_rate (now {self.settings.learning_rate})."
                )
            norms.append(self.state.descend(rate))
            losses.append(loss)
            if on_step is not None:
                on_step(StepReport(step + 1, num_steps, loss))
        duration_s = time.perf_counter() - started
        return EpochReport(
            epoch=epoch + 1,
            loss=sum(losses) / len(losses),
            validation_loss=self._validation_loss(epoch),
            learning_rate=rate,
            gradient_norm=sum(norms) / len(norms),
            duration_s=duration_s,
            samples_per_s=len(order) / duration_s,
        )

    def _minibatches(self, order: Tensor, epoch: int, *, is_training: bool) -> Iterator[_Minibatch]:
        """Cut an order of pairs into minibatches and draw what chance decides about each."""
        generator = torch.Generator(self.device).manual_seed(epoch_seed(self.seed, epoch, 0))
        has_weights = is_training and self.learner.config.density.weighting == "loss"
        for indices in order.split(self.settings.batch_size):
            chance = self.learner.draw(self.actions[indices.to(self.device)], generator=generator)
            rows = self.team.part(len(indices))
            own = indices[rows]
            yield _Minibatch(
                self.demonstrations.batch(own).to(self.device),
                chance.part(rows),
                self.weights[own].to(self.device) if has_weights else None,
                len(own) / len(indices),
            )

    def _loss(self, minibatch: _Minibatch) -> Tensor:
        """What the pairs of this process add to the mean loss of the minibatch."""
        if minibatch.share == 0:
            return torch.zeros((), device=self.device)
        bfloat16 = self.settings.precision == "bfloat16"
        with torch.autocast(self.device.type, torch.bfloat16, enabled=bfloat16):
            loss = self.learner.loss(minibatch.batch, minibatch.chance, weights=minibatch.weights)
        return loss * minibatch.share

    def _differentiate(self, minibatch: _Minibatch) -> float:
        """Put the gradients of a whole minibatch in place, and return its mean loss."""
        self.state.clear_gradients()
        loss = self._loss(minibatch)
        if loss.requires_grad:
            loss.backward()
        loss = loss.detach()
        sum_over(self.team, [loss, *self.state.gradients()])
        return loss.item()

    @torch.no_grad()
    def _validation_loss(self, epoch: int) -> float | None:
        held_out = torch.arange(self.num_training, len(self.demonstrations))
        if len(held_out) == 0:
            return None
        total = torch.zeros((), device=self.device)
        lengths = [len(indices) for indices in held_out.split(self.settings.batch_size)]
        minibatches = self._minibatches(held_out, epoch, is_training=False)
        for minibatch, length in zip(minibatches, lengths, strict=True):
            total += self._loss(minibatch) * length
        sum_over(self.team, [total])
        return total.item() / len(held_out)
