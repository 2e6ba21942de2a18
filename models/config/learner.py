"""Everything that makes one learner what it is."""

import dataclasses
from typing import Literal, get_args

from models.config.checks import require
from models.config.explicit import BetaConfig
from models.config.implicit import DensityConfig, NegativesConfig
from models.config.langevin import LangevinNegativesConfig
from models.config.network import NetworkConfig
from models.config.optimiser import OptimiserConfig
from models.config.samplers import SamplerConfig
from models.config.undoing import require_undoable

Method = Literal["bc-beta", "ibc", "da-ibc", "ibc-langevin"]

METHODS: tuple[Method, ...] = get_args(Method)


@dataclasses.dataclass(frozen=True, slots=True)
class LearnerConfig:
    """Everything that makes one learner what it is.

    Attributes:
        method: How it learns; IBC takes uniform negatives, DA-IBC disturbed expert actions.
        network: What the encoder sees.
        beta: Loss and inference of BC-Beta.
        negatives: Negatives of IBC and DA-IBC.
        langevin_negatives: Chains and gradient penalty of Langevin IBC.
        density: Kernel density estimate and what it weighs.
        sampler: How IBC and DA-IBC choose actions.
        optimiser: How the loss is descended on.
    """

    method: Method
    network: NetworkConfig = dataclasses.field(default_factory=NetworkConfig)
    beta: BetaConfig = dataclasses.field(default_factory=BetaConfig)
    negatives: NegativesConfig = dataclasses.field(default_factory=NegativesConfig)
    langevin_negatives: LangevinNegativesConfig = dataclasses.field(
        default_factory=LangevinNegativesConfig
    )
    density: DensityConfig = dataclasses.field(default_factory=DensityConfig)
    sampler: SamplerConfig = dataclasses.field(default_factory=SamplerConfig)
    optimiser: OptimiserConfig = dataclasses.field(default_factory=OptimiserConfig)

    def __post_init__(self) -> None:
        require(self, "method", self.method in METHODS, f"one of {', '.join(METHODS)}")
        require_undoable(
            self.sampler.undo, method=self.method, negatives=self.negatives, density=self.density
        )
