"""Settings of policies whose network gives a distribution."""

import dataclasses
from typing import Literal

from models.config.checks import require, require_not_negative, require_positive


@dataclasses.dataclass(frozen=True, slots=True)
class BetaConfig:
    """Loss and inference of BC-Beta, and of each component of a BC mixture; without effect on the other methods.

    Attributes:
        beta_offset: What both concentrations exceed; 1 forbids densities with peaks at both ends [-].
        label_clamp: Smallest distance that labels, rescaled to [0, 1], keep from the ends [-].
        label_noise: Standard deviation of the noise on labels in training; without it labels that repeat exactly draw the concentrations to infinity [-].
        entropy_bonus: Factor on the entropy that is subtracted from the loss; BC-Beta alone has it in closed form [-].
        inference: Which action the distribution gives; the mode of a mixture is the mode of a component, the one where the mixture is densest.
    """

    beta_offset: Literal[0, 1] = 0
    label_clamp: float = 1e-3
    label_noise: float = 0.0
    entropy_bonus: float = 0.0
    inference: Literal["mode", "mean", "sample"] = "mode"

    def __post_init__(self) -> None:
        # In float32 the other end of a smaller one is 1.
        require(self, "label_clamp", 1e-7 <= self.label_clamp < 0.5, "a number in [1e-7, 0.5)")
        require_not_negative(self, "label_noise")
        require_not_negative(self, "entropy_bonus")


@dataclasses.dataclass(frozen=True, slots=True)
class MixtureConfig:
    """Size of a BC mixture; loss and inference are those of `BetaConfig`.

    Attributes:
        components: Products of two Betas in the mixture [-].
    """

    components: int = 5

    def __post_init__(self) -> None:
        require_positive(self, "components")


@dataclasses.dataclass(frozen=True, slots=True)
class CategoricalConfig:
    """Resolution, loss and inference of a BC grid.

    Attributes:
        points: Grid points along each action component; odd numbers have zero among them.
        smoothing: Standard deviation of the Gaussian that spreads a label over the points; 0 gives all to the nearest [-].
        choice: Whether the grid is sampled from, or the densest point is taken.
        temperature: Log densities are divided by it before they are sampled from; below 1 sharpens [-].
    """

    points: int = 65
    smoothing: float = 0.0
    choice: Literal["sample", "argmax"] = "sample"
    temperature: float = 1.0

    def __post_init__(self) -> None:
        require(self, "points", self.points >= 2, "at least 2")
        require_not_negative(self, "smoothing")
        require_positive(self, "temperature")
