"""Model cards: how a shipped policy was made, how well it drives, and how to see that it is the one."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from mjdrive.config import read_json
from mjdrive.evaluation.spread import DrivesSummary
from mjdrive.learning.training import Source
from mjdrive.zoo.entries import CARD


@dataclass(frozen=True, slots=True)
class Weights:
    """What a policy consists of.

    Attributes:
        number_format: "float16", small tensors aside, or "float32".
        sha256: Digest of `model.safetensors`, hexadecimal.
        trained_sha256: Digest of that file as training left it, in float32, hexadecimal.
        largest_variation: Largest total variation between what both would do at one observation [-].
        mean_variation: Mean of it over the observations [-].
        observations: Observations that both were asked at [-].
        expert_actions: Expert actions that are kept for searches to start from, evenly over the demonstrations; 0 if it
            never searches, or if the card is from before they were counted [-].
    """

    number_format: str
    sha256: str
    trained_sha256: str
    largest_variation: float
    mean_variation: float
    observations: int
    expert_actions: int = 0


@dataclass(frozen=True, slots=True)
class Training:
    """How the weights were found.

    Attributes:
        commands: All that has to be run, in order.
        seed: Of the run [-].
        epochs: That the commands train; the weights are from the last one that has a loss below [-].
        losses: Mean loss of each epoch up to these weights [nats].
        validation_losses: Loss of the pairs held out after each epoch [nats]; none where none were.
        duration_s: Time taken [s].
    """

    commands: tuple[str, ...]
    seed: int
    epochs: int
    losses: tuple[float, ...]
    validation_losses: tuple[float, ...]
    duration_s: float


@dataclass(frozen=True, slots=True)
class Evaluation:
    """How it drives.

    Attributes:
        command: What makes these drives again.
        weights_sha256: Digest of the weights that drove: those shipped, or those that training left.
        steps: Control steps of each drive [-].
        summary: Figures of the drives.
    """

    command: str
    weights_sha256: str
    steps: int
    summary: DrivesSummary


@dataclass(frozen=True, slots=True)
class ReferenceDrive:
    """A short drive on the CPU, with energies in float32 whatever the machine is fast at.

    Attributes:
        town: Name of the town.
        seed: Of the drive [-].
        steps: Control steps [-].
        distance_m: Path length on driving lanes [m].
        end_x: Rear axle at the last step, world frame [m].
        end_y: Rear axle at the last step, world frame [m].
        actions_sha256: Digest of all actions, hexadecimal.
        rounding: How the machine rounds: what its processor can do, and a digest of what the network said first.
        versions: Of the software that decides the bytes.
    """

    town: str
    seed: int
    steps: int
    distance_m: float
    end_x: float
    end_y: float
    actions_sha256: str
    rounding: str
    versions: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class ModelCard:
    """All that is known of a shipped policy but its settings, which are in `config.json`.

    Attributes:
        name: Of the entry.
        method: How it learnt.
        weights: What it consists of.
        source: What it learnt from.
        training: How it learnt.
        reference: A drive to check it by.
        evaluations: How it drives.
    """

    name: str
    method: str
    weights: Weights
    source: Source
    training: Training
    reference: ReferenceDrive
    evaluations: tuple[Evaluation, ...] = ()


def read_card(entry: Path) -> ModelCard:
    """Read the card of an entry.

    Raises:
        ConfigError: If it is missing or no card.
    """
    return read_json(ModelCard, entry / CARD)
