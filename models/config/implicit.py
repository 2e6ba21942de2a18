"""What an energy is trained against, and how training evens out the demonstrations."""

import dataclasses
from typing import Literal

from models.config.checks import require, require_not_negative, require_positive, require_share

DensityKind = Literal["joint", "product"]


@dataclasses.dataclass(frozen=True, slots=True)
class NegativesConfig:
    """Negatives of IBC (uniform), DA-IBC (disturbed expert actions) and Langevin IBC (ends of chains).

    All but `count` and `uniform_share` is for DA-IBC alone, and IBC has no use for the share either.

    Attributes:
        count: Negatives of each training pair.
        sigma: Standard deviation of the noise on expert actions; not given in the paper [-].
        clip: Whether disturbed actions are brought back into [-1, 1]; not said in the paper.
        uniform_share: Share of the negatives that are uniform after all [-].
        pool: Which expert actions are disturbed: those of the training minibatch, or all.
        correction: "ranking" adds the log density of the negatives to the energies in training, so that they learn p(y | x); "none" is the paper's.
    """

    count: int = 256
    sigma: float = 0.22
    clip: bool = True
    uniform_share: float = 0.0
    pool: Literal["minibatch", "dataset"] = "minibatch"
    correction: Literal["none", "ranking"] = "none"

    def __post_init__(self) -> None:
        require_positive(self, "count")
        require_not_negative(self, "sigma")
        require_share(self, "uniform_share")
        require(
            self,
            "correction",
            self.correction == "none" or (self.sigma > 0 and not self.clip),
            "none, or noise of positive sigma without clip, which would pile negatives up on the edges",
        )


@dataclasses.dataclass(frozen=True, slots=True)
class DensityConfig:
    """Kernel density estimate of the expert actions, and how training evens it out.

    Attributes:
        bandwidth: Standard deviation h of the Gaussian kernel [-].
        kind: "joint" for a kernel over both action components, "product" for the product of two one-dimensional estimates.
        weighting: What 1 / KDE weighs: nothing, how often a pair is drawn, or its loss.
        exponent: Power of 1 / KDE; 1 is the paper's, smaller is milder [-].
        cap: Largest weight over the mean weight, or None for no limit [-].
    """

    bandwidth: float = 0.2
    kind: DensityKind = "joint"
    weighting: Literal["none", "sampler", "loss"] = "sampler"
    exponent: float = 1.0
    cap: float | None = None

    def __post_init__(self) -> None:
        require_positive(self, "bandwidth")
        require_not_negative(self, "exponent")
        require(self, "cap", self.cap is None or self.cap >= 1, "None or a number from 1 up")
