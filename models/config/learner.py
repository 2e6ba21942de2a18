"""Everything that makes one learner what it is."""

import dataclasses
from typing import Literal, get_args

from models.config.checks import require
from models.config.commitment import CommitmentConfig
from models.config.evenness import EvennessConfig
from models.config.explicit import BetaConfig, CategoricalConfig, MixtureConfig
from models.config.generative import DenoiserConfig, DiffusionConfig, FlowConfig
from models.config.implicit import DensityConfig, NegativesConfig
from models.config.langevin import LangevinNegativesConfig
from models.config.network import NetworkConfig
from models.config.optimiser import OptimiserConfig
from models.config.perturbation import PerturbationConfig
from models.config.samplers import SamplerConfig
from models.config.undoing import require_undoable

Method = Literal[
    "bc-beta", "bc-mixture", "bc-grid", "ibc", "da-ibc", "ibc-langevin", "diffusion", "flow"
]

METHODS: tuple[Method, ...] = get_args(Method)


@dataclasses.dataclass(frozen=True, slots=True)
class LearnerConfig:
    """Everything that makes one learner what it is.

    Attributes:
        method: How it learns; IBC takes uniform negatives, DA-IBC disturbed expert actions.
        network: What the encoder sees.
        beta: Loss and inference of BC-Beta and of the BC mixture.
        mixture: Size of the BC mixture.
        categorical: Resolution, loss and inference of the BC grid.
        denoiser: The network of diffusion and flow matching, and how its density is told.
        diffusion: Loss and inference of diffusion.
        flow: Inference of flow matching.
        negatives: Negatives of IBC and DA-IBC.
        langevin_negatives: Chains and gradient penalty of Langevin IBC.
        density: Kernel density estimate and what it weighs.
        evenness: How evenly training draws what was seen.
        perturbation: From where demonstrations are seen.
        sampler: How IBC and DA-IBC choose actions.
        commitment: How long the chance of steering lasts, where actions are sampled from a density, in closed form, on a grid or estimated from many draws.
        optimiser: How the loss is descended on.
    """

    method: Method
    network: NetworkConfig = dataclasses.field(default_factory=NetworkConfig)
    beta: BetaConfig = dataclasses.field(default_factory=BetaConfig)
    mixture: MixtureConfig = dataclasses.field(default_factory=MixtureConfig)
    categorical: CategoricalConfig = dataclasses.field(default_factory=CategoricalConfig)
    denoiser: DenoiserConfig = dataclasses.field(default_factory=DenoiserConfig)
    diffusion: DiffusionConfig = dataclasses.field(default_factory=DiffusionConfig)
    flow: FlowConfig = dataclasses.field(default_factory=FlowConfig)
    negatives: NegativesConfig = dataclasses.field(default_factory=NegativesConfig)
    langevin_negatives: LangevinNegativesConfig = dataclasses.field(
        default_factory=LangevinNegativesConfig
    )
    density: DensityConfig = dataclasses.field(default_factory=DensityConfig)
    evenness: EvennessConfig = dataclasses.field(default_factory=EvennessConfig)
    perturbation: PerturbationConfig = dataclasses.field(default_factory=PerturbationConfig)
    sampler: SamplerConfig = dataclasses.field(default_factory=SamplerConfig)
    commitment: CommitmentConfig = dataclasses.field(default_factory=CommitmentConfig)
    optimiser: OptimiserConfig = dataclasses.field(default_factory=OptimiserConfig)

    def __post_init__(self) -> None:
        require(self, "method", self.method in METHODS, f"one of {', '.join(METHODS)}")
        require(
            self.beta,
            "entropy_bonus",
            self.beta.entropy_bonus == 0 or self.method != "bc-mixture",
            "0 for bc-mixture, as the entropy of a mixture has no closed form",
        )
        require(
            self.negatives,
            "correction",
            self.negatives.correction == "none" or self.method != "ibc-langevin",
            "none for ibc-langevin, as nobody knows the density of what chains end at",
        )
        require(
            self.evenness,
            "speed_exponent",
            self.evenness.speed_exponent == 0 or "speed" in self.network.state_inputs,
            "0 where network.state_inputs has no speed, or what is not seen would tilt what is learnt",
        )
        require_undoable(
            self.sampler.undo,
            method=self.method,
            negatives=self.negatives,
            density=self.density,
            evenness=self.evenness,
        )
