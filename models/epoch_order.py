"""Which demonstrations an epoch shows, and in what order."""

import dataclasses

import torch
from jaxtyping import Float, Int
from torch import Tensor

from models.config import LearnerConfig
from models.errors import TrainingError
from models.evenness import speed_weights
from models.samplers.draws import draw_categorical


@dataclasses.dataclass(frozen=True, eq=False, slots=True)
class EpochOrder:
    """Decides the order of every epoch from the seed alone, so that no generator state has to be saved.

    Attributes:
        config: Settings of the learner.
        seed: Of the run [-].
        speeds: Speed that was seen in each pair to train on [m/s].
        weights: 1 / density of the action of each pair [-], used where that decides how often a pair is drawn.

    Raises:
        TrainingError: If there are fewer pairs than parts of a pass.
    """

    config: LearnerConfig
    seed: int
    speeds: Float[Tensor, " D"]
    weights: Float[Tensor, " D"]

    def __post_init__(self) -> None:
        parts = self.config.optimiser.epochs_per_pass
        if len(self.speeds) < parts:
            raise TrainingError(
                f"{len(self.speeds)} demonstrations cannot be cut into {parts} epochs. Collect more, or lower "
                f"optimiser.epochs_per_pass."
            )

    def of(self, epoch: int) -> Int[Tensor, " N"]:
        """Indices of the pairs of one epoch, the first of which is 0: its part of those of a pass."""
        parts = self.config.optimiser.epochs_per_pass
        done, part = divmod(epoch, parts)
        return self._of_pass(done).tensor_split(parts)[part]

    def _of_pass(self, done: int) -> Int[Tensor, " D"]:
        """Indices of the pairs of the pass after so many: each once, or drawn by weight with replacement."""
        generator = torch.Generator().manual_seed(epoch_seed(self.seed, done, 1))
        density, evenness = self.config.density, self.config.evenness
        if density.weighting != "sampler" and evenness.speed_exponent == 0:
            return torch.randperm(len(self.speeds), generator=generator)
        weights = speed_weights(self.speeds, evenness)
        if density.weighting == "sampler":
            weights = weights * self.weights
        return draw_categorical(weights[None], len(self.speeds), generator=generator)[0]


def epoch_seed(seed: int, epoch: int, stream: int) -> int:
    """Seed of one stream of chance in one epoch, so that no generator state has to be saved."""
    return ((seed * 1_000_003 + epoch) * 2 + stream) % 2**63
