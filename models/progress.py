"""What training says about itself while it goes on."""

import json
from dataclasses import asdict, dataclass
from typing import NamedTuple


class StepReport(NamedTuple):
    """One step of the optimiser.

    Attributes:
        step: Steps done since the first epoch.
        num_steps: Steps of the whole run.
        loss: Loss of the minibatch [nats].
    """

    step: int
    num_steps: int
    loss: float


@dataclass(frozen=True, slots=True)
class EpochReport:
    """One pass over the demonstrations.

    Attributes:
        epoch: Which pass, from 1.
        loss: Mean loss of its minibatches [nats].
        validation_loss: Unweighted loss of the pairs held out [nats], or None where none are.
        learning_rate: Step size of the last step [-].
        gradient_norm: Mean norm of the gradient before clipping [-].
        duration_s: Time taken, checkpoint excluded [s].
        samples_per_s: Pairs trained on in a second [1/s].
    """

    epoch: int
    loss: float
    validation_loss: float | None
    learning_rate: float
    gradient_norm: float
    duration_s: float
    samples_per_s: float


def to_lines(history: list[EpochReport]) -> str:
    """Write reports as text, one JSON object a line."""
    return "".join(json.dumps(asdict(report)) + "\n" for report in history)


def from_lines(text: str) -> list[EpochReport]:
    """Read what `to_lines` wrote."""
    return [EpochReport(**json.loads(line)) for line in text.splitlines()]
