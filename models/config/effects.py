"""Which settings have an effect on which method; all that compares settings of learners goes by it."""

import dataclasses
from collections.abc import Mapping

from models.config.commitment import CommitmentConfig
from models.config.learner import LearnerConfig, Method

_SHARED = ("method", "network.", "density.", "evenness.", "perturbation.", "optimiser.")

_ENERGY = ("negatives.", "sampler.", "commitment.")

_OWN: Mapping[Method, tuple[str, ...]] = {
    "bc-beta": ("beta.", "commitment."),
    "bc-mixture": ("beta.", "mixture.", "commitment."),
    "bc-grid": ("categorical.", "commitment."),
    "ibc": _ENERGY,
    "da-ibc": _ENERGY,
    "ibc-langevin": (*_ENERGY, "langevin_negatives."),
    "diffusion": ("denoiser.", "diffusion.", "commitment."),
    "flow": ("denoiser.", "flow.", "commitment."),
}

_SAMPLERS = ("dfo", "grid", "langevin")


def settings_of(method: Method) -> tuple[str, ...]:
    """How the dotted names of the settings begin that have an effect on a method, whichever its sampler is."""
    return (*_SHARED, *_OWN[method])


def is_idle(name: str, config: LearnerConfig) -> bool:
    """Whether a setting, by its dotted name, changes nothing of how a learner learns and acts."""
    others = tuple(f"sampler.{kind}." for kind in _SAMPLERS if kind != config.sampler.kind)
    if not _samples(config):
        others = (*others, "commitment.")
    if config.commitment.hold == 0:
        others = (*others, "denoiser.candidates")
    if config.perturbation.share == 0:
        others = (*others, "perturbation.offset", "perturbation.heading")
    return not name.startswith(settings_of(config.method)) or name.startswith(others)


def _samples(config: LearnerConfig) -> bool:
    """Whether actions are drawn from something whose quantiles can be kept to."""
    if config.method in ("bc-beta", "bc-mixture"):
        return config.beta.inference == "sample"
    if config.method in ("diffusion", "flow"):
        return True
    if config.method == "bc-grid":
        return config.categorical.choice == "sample"
    return config.sampler.kind == "grid" and config.sampler.grid.choice == "sample"


def density_settings(config: LearnerConfig) -> LearnerConfig:
    """Settings that decide the density which a learner tells: those of drawing from it are the same for all.

    Learners with the same weights tell the same density, to the byte, if these are equal.
    """
    replace = dataclasses.replace
    grid = replace(config.sampler.grid, choice="sample", temperature=1.0)
    return replace(
        config,
        beta=replace(config.beta, inference="sample"),
        categorical=replace(config.categorical, choice="sample", temperature=1.0),
        denoiser=replace(config.denoiser, candidates=1),
        sampler=replace(config.sampler, grid=grid),
        commitment=CommitmentConfig(),
    )
