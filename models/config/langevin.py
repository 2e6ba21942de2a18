"""Langevin chains: how they walk, how actions are chosen by them, and how negatives are made by them."""

import dataclasses
from typing import Literal

from models.config.checks import require, require_not_negative, require_positive

Start = Literal["inverse_kde", "kde", "uniform"]


@dataclasses.dataclass(frozen=True, slots=True)
class ChainConfig:
    """How a chain walks: half a step down the slope of the energy, and noise. The defaults are those of Florence et al.

    Attributes:
        iterations: Steps of each chain.
        step_init: First step size [-].
        step_final: Last step size [-].
        step_power: Power of the polynomial by which steps shrink from first to last [-].
        noise_scale: Factor on the noise; 0 is plain descent [-].
        noise: "step" multiplies the noise by the step size, as published code does, so that chains come to rest at minima; "root" by its square root, with which they settle to exp(-E).
        step_clip: Largest change of an action component in one step [-].
    """

    iterations: int = 100
    step_init: float = 0.1
    step_final: float = 1e-5
    step_power: float = 2.0
    noise_scale: float = 1.0
    noise: Literal["step", "root"] = "step"
    step_clip: float = 0.1

    def __post_init__(self) -> None:
        require_positive(self, "iterations", "step_init", "step_final", "step_clip")
        require_not_negative(self, "step_power")
        require_not_negative(self, "noise_scale")
        require(
            self,
            "step_final",
            self.step_final <= self.step_init,
            f"at most step_init, {self.step_init}",
        )


@dataclasses.dataclass(frozen=True, slots=True)
class LangevinConfig:
    """Choice of an action by chains.

    Attributes:
        num_chains: Chains of each observation.
        start: How first candidates are drawn: expert actions by 1 / KDE or by KDE, or uniform actions.
        choice: "argmin" takes the lowest end of a chain, "sample" draws one of the ends by exp(-E), "chain" takes the end of one chain whatever its energy.
        chain: How the chains walk.
    """

    num_chains: int = 512
    start: Start = "uniform"
    choice: Literal["argmin", "sample", "chain"] = "argmin"
    chain: ChainConfig = ChainConfig()

    def __post_init__(self) -> None:
        require_positive(self, "num_chains")


@dataclasses.dataclass(frozen=True, slots=True)
class LangevinNegativesConfig:
    """Negatives of Langevin IBC, and its gradient penalty; without effect on the other methods.

    Attributes:
        chain: How uniform actions walk to where the energy is low, and become negatives.
        penalty_weight: Factor on the gradient penalty; 0 leaves it out [-].
        penalty_margin: Slope of the energy, for either action component, up to which there is no penalty [nats].
    """

    chain: ChainConfig = ChainConfig()
    penalty_weight: float = 1.0
    penalty_margin: float = 1.0

    def __post_init__(self) -> None:
        require_not_negative(self, "penalty_weight")
        require_not_negative(self, "penalty_margin")
