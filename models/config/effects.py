"""Which settings have an effect on which method; all that compares settings of learners goes by it."""

from collections.abc import Mapping

from models.config.learner import LearnerConfig, Method

_SHARED = ("method", "network.", "density.", "evenness.", "optimiser.")

_ENERGY = ("negatives.", "sampler.", "commitment.")

_OWN: Mapping[Method, tuple[str, ...]] = {
    "bc-beta": ("beta.",),
    "bc-mixture": ("beta.", "mixture."),
    "bc-grid": ("categorical.", "commitment."),
    "ibc": _ENERGY,
    "da-ibc": _ENERGY,
    "ibc-langevin": (*_ENERGY, "langevin_negatives."),
    "diffusion": ("denoiser.", "diffusion."),
    "flow": ("denoiser.", "flow."),
}

_SAMPLERS = ("dfo", "grid", "langevin")


def settings_of(method: Method) -> tuple[str, ...]:
    """How the dotted names of the settings begin that have an effect on a method, whichever its sampler is."""
    return (*_SHARED, *_OWN[method])


def is_idle(name: str, config: LearnerConfig) -> bool:
    """Whether a setting, by its dotted name, changes nothing of how a learner learns and acts."""
    others = tuple(f"sampler.{kind}." for kind in _SAMPLERS if kind != config.sampler.kind)
    if config.method != "bc-grid" and config.sampler.kind != "grid":
        others = (*others, "commitment.")
    return not name.startswith(settings_of(config.method)) or name.startswith(others)
