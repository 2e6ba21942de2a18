"""Trained network -> `Policy[Observation]`."""

import dataclasses
from pathlib import Path

import torch

from mjdrive.datatypes import Action, Observation
from mjdrive.errors import RunError
from mjdrive.learning.settings import acting_settings
from models import checkpoint
from models.energy_scoring import resolved
from models.errors import ModelsError
from models.interfaces import Learner


class Pilot:
    """Drives with a trained network.

    The same seed gives the same actions with any number of threads, but not with another number format, so `config` says
    the one that is used here where the settings of the run leave it open.

    Args:
        learner: The network.
        name: How summaries call it.

    Attributes:
        name: How summaries call it.
        config: Settings of the network, with the number format that it acts in.
    """

    def __init__(self, learner: Learner, *, name: str) -> None:
        sampler = learner.config.sampler
        sampler = dataclasses.replace(sampler, precision=resolved(sampler.precision))
        learner.config = dataclasses.replace(learner.config, sampler=sampler)
        self.name = name
        self.config = learner.config
        self._learner = learner.eval()
        self._generator = torch.Generator()

    def reset(self, seed: int) -> None:
        """Start a new stream of random numbers."""
        self._generator.manual_seed(seed)

    @torch.inference_mode()
    def act(self, view: Observation) -> Action:
        """Choose the action for the next control interval."""
        bev = torch.tensor(view.bev)[None]
        state = torch.tensor(view.state)[None]
        chosen = self._learner.act(bev, state, generator=self._generator)
        acceleration, steering = chosen[0].tolist()
        return Action(acceleration=acceleration, steering=steering)


def load(run: Path, *, preset: str | None = None) -> Pilot:
    """Load the policy of a training run.

    Args:
        run: Folder that `mjdrive train` made.
        preset: Whose way to choose actions to take; the run's own if None.

    Returns:
        The policy, named after the folder.

    Raises:
        RunError: If the folder is no run, or a file of it is damaged.
        ConfigError: If there is no such preset.
    """
    try:
        learner = checkpoint.load(run)
    except ModelsError as error:
        raise RunError(str(error)) from error
    if preset is not None:
        learner.config = acting_settings(learner.config, preset=preset)
    return Pilot(learner, name=run.resolve().name)
