"""Trained network -> `Policy[Observation]`."""

import dataclasses
from collections.abc import Iterable
from pathlib import Path

import torch

from mjdrive.datatypes import Action, Observation
from mjdrive.errors import RunError
from mjdrive.learning.settings import acting_changed, acting_settings
from models import checkpoint
from models.energy_scoring import resolved_for
from models.errors import ModelsError
from models.hardware import choose_device
from models.interfaces import Learner
from models.samplers.commitment import Commitment


class Pilot:
    """Drives with a trained network.

    The same seed gives the same actions with any number of threads, but not on another device or with another number
    format, so `device` says where it acts, and `config` in which format where the settings of the run leave it open.

    Args:
        learner: The network; it is moved.
        name: How summaries call it.
        device: Where it acts; a GPU where there is one, else the CPU, if None.

    Attributes:
        name: How summaries call it.
        device: Where it acts.
        config: Settings of the network, with the number format that it acts in.
        learner: The network itself, for those who want to look into it.
    """

    def __init__(
        self, learner: Learner, *, name: str, device: torch.device | str | None = None
    ) -> None:
        self.device = choose_device() if device is None else torch.device(device)
        sampler = learner.config.sampler
        precision = resolved_for(sampler, self.device)
        sampler = dataclasses.replace(sampler, precision=precision)
        learner.config = dataclasses.replace(learner.config, sampler=sampler)
        self.name = name
        self.config = learner.config
        self.learner = learner.to(self.device).eval()
        self._generator = torch.Generator(self.device)
        self._commitment: Commitment | None = None

    def reset(self, seed: int) -> None:
        """Start a new stream of random numbers."""
        self._generator.manual_seed(seed)
        self._commitment = None

    @torch.inference_mode()
    def act(self, view: Observation) -> Action:
        """Choose the action for the next control interval."""
        bev = torch.tensor(view.bev, device=self.device)[None]
        state = torch.tensor(view.state, device=self.device)[None]
        chosen = self.learner.act(bev, state, generator=self._generator, commitment=self._lasting())
        acceleration, steering = chosen[0].tolist()
        return Action(acceleration=acceleration, steering=steering)

    def _lasting(self) -> Commitment | None:
        """What lasts from decision to decision of this drive; None if nothing does."""
        if self.config.commitment.hold == 0:
            return None
        if self._commitment is None:
            self._commitment = Commitment(self.config.commitment, 1, generator=self._generator)
        return self._commitment


def load(
    run: Path,
    *,
    name: str | None = None,
    preset: str | None = None,
    acting: Iterable[str] = (),
    device: torch.device | str | None = None,
) -> Pilot:
    """Load the policy of a training run.

    Args:
        run: Folder that `mjdrive train` made, or that of a shipped policy.
        name: How summaries call it; as the folder if None.
        preset: Whose way to choose actions to take; the run's own if None.
        acting: Changes to that way, each as "commitment.hold=0".
        device: Where it acts; a GPU where there is one, else the CPU, if None.

    Returns:
        The policy.

    Raises:
        RunError: If the folder is no run, or a file of it is damaged.
        ConfigError: If there is no such preset, or a change is none or decides what is learnt.
        UnknownNameError: If there is no such setting.
    """
    try:
        learner = checkpoint.load(run)
    except ModelsError as error:
        raise RunError(str(error)) from error
    if preset is not None:
        learner.config = acting_settings(learner.config, preset=preset)
    learner.config = acting_changed(learner.config, acting)
    return Pilot(learner, name=name or run.resolve().name, device=device)
