"""How a loss is descended on."""

import dataclasses
import math
from typing import Literal

from models.config.checks import require, require_not_negative, require_positive
from models.config.samplers import Precision


@dataclasses.dataclass(frozen=True, slots=True)
class OptimiserConfig:
    """How the loss is descended on: Adam, with decoupled weight decay where there is any.

    Attributes:
        learning_rate: Step size, the highest one of a schedule [-].
        schedule: "constant", or "onecycle": up over the first 30 % of all steps, then down to nothing.
        epochs: After each of them there is a checkpoint: passes over the demonstrations, or parts of passes [-].
        epochs_per_pass: Epochs that a pass is cut into, each over other demonstrations; more than 1 where there are many [-].
        batch_size: Pairs of each step.
        weight_decay: Decoupled weight decay [-].
        gradient_clip: Largest norm of the gradient, or None for no limit [-].
        precision: Number format of the products; losses, energies and weights stay float32. "auto" takes bfloat16 where the machine is fast at it; a run that goes on keeps what it began with.
        validation_share: Share of the pairs, from the end, that are held out to report their loss [-].
        ema_decay: Decay a step of the running mean of the weights that is saved to act with; 0 saves the weights themselves [-].
    """

    learning_rate: float = 1e-5
    schedule: Literal["constant", "onecycle"] = "constant"
    epochs: int = 400
    epochs_per_pass: int = 1
    batch_size: int = 128
    weight_decay: float = 0.0
    gradient_clip: float | None = None
    precision: Precision = "auto"
    validation_share: float = 0.0
    ema_decay: float = 0.0

    def __post_init__(self) -> None:
        require_positive(self, "learning_rate", "epochs", "epochs_per_pass", "batch_size")
        require_not_negative(self, "weight_decay")
        if self.gradient_clip is not None:
            require_positive(self, "gradient_clip")
        require(self, "validation_share", 0 <= self.validation_share < 1, "a share in [0, 1)")
        require(self, "ema_decay", 0 <= self.ema_decay < 1, "a number in [0, 1)")

    def steps_per_epoch(self, num_pairs: int) -> int:
        """Steps of an epoch, the last one of it perhaps with fewer pairs [-].

        Args:
            num_pairs: Demonstrations that are trained on [-].
        """
        return math.ceil(math.ceil(num_pairs / self.epochs_per_pass) / self.batch_size)
