"""Settings of policies whose network gives a distribution."""

import dataclasses
from typing import Literal

from models.config.checks import require, require_not_negative


@dataclasses.dataclass(frozen=True, slots=True)
class BetaConfig:
    """Loss and inference of BC-Beta; without effect on the other methods.

    Attributes:
        beta_offset: Added to both concentrations after softplus; 1 forbids densities with peaks at both ends [-].
        label_clamp: Smallest distance that labels, rescaled to [0, 1], keep from the ends [-].
        label_noise: Standard deviation of the noise on labels in training; without it labels that repeat exactly draw the concentrations to infinity [-].
        entropy_bonus: Factor on the entropy that is subtracted from the loss [-].
        inference: Which action the distribution gives.
    """

    beta_offset: Literal[0, 1] = 0
    label_clamp: float = 1e-3
    label_noise: float = 0.0
    entropy_bonus: float = 0.0
    inference: Literal["mode", "mean", "sample"] = "mode"

    def __post_init__(self) -> None:
        require(self, "label_clamp", 0 < self.label_clamp < 0.5, "a number in (0, 0.5)")
        require_not_negative(self, "label_noise")
        require_not_negative(self, "entropy_bonus")
