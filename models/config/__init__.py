"""Every setting of the learners, among them each ambiguity of the paper; presets are in `models.presets`."""

from models.config.commitment import CommitmentConfig
from models.config.effects import density_settings, is_idle, settings_of
from models.config.evenness import EvennessConfig
from models.config.explicit import BetaConfig, CategoricalConfig, MixtureConfig
from models.config.generative import DenoiserConfig, DiffusionConfig, FlowConfig
from models.config.implicit import DensityConfig, DensityKind, NegativesConfig
from models.config.langevin import ChainConfig, LangevinConfig, LangevinNegativesConfig, Start
from models.config.learner import METHODS, LearnerConfig, Method
from models.config.network import STATE_INPUTS, NetworkConfig, StateInput
from models.config.optimiser import OptimiserConfig
from models.config.perturbation import PerturbationConfig
from models.config.samplers import Choice, DfoConfig, GridConfig, Precision, SamplerConfig, Undo

__all__ = [
    "METHODS",
    "STATE_INPUTS",
    "BetaConfig",
    "CategoricalConfig",
    "ChainConfig",
    "Choice",
    "CommitmentConfig",
    "DenoiserConfig",
    "DensityConfig",
    "DensityKind",
    "DfoConfig",
    "DiffusionConfig",
    "EvennessConfig",
    "FlowConfig",
    "GridConfig",
    "LangevinConfig",
    "LangevinNegativesConfig",
    "LearnerConfig",
    "Method",
    "MixtureConfig",
    "NegativesConfig",
    "NetworkConfig",
    "OptimiserConfig",
    "PerturbationConfig",
    "Precision",
    "SamplerConfig",
    "Start",
    "StateInput",
    "Undo",
    "density_settings",
    "is_idle",
    "settings_of",
]
