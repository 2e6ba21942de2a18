"""Settings of policies that turn noise into an action, step by step."""

import dataclasses
from typing import Literal

from models.config.checks import require_positive


@dataclasses.dataclass(frozen=True, slots=True)
class DenoiserConfig:
    """The network of both generative methods, and how its density is told.

    Attributes:
        width: Hidden units of each of its three layers [-].
        action_gain: Factor on the first weights of the noisy action; 1 is plain initialisation, more tells near actions apart sooner [-].
        draws: Noises and times that each training pair is seen with; its picture is encoded once for all of them [-].
        noise_floor: Standard deviation of the noise that an action keeps where its density is told or estimated: labels that repeat exactly have none without it [-].
        density_steps: Steps of the integration that tells it, of four evaluations of the network each [-].
        candidates: Actions that are drawn at each decision to estimate it from, where the chance of steering lasts [-].
    """

    width: int = 128
    action_gain: float = 8.0
    draws: int = 16
    noise_floor: float = 0.05
    density_steps: int = 12
    candidates: int = 256

    def __post_init__(self) -> None:
        require_positive(self, "width", "action_gain", "draws", "noise_floor", "density_steps")
        require_positive(self, "candidates")


@dataclasses.dataclass(frozen=True, slots=True)
class DiffusionConfig:
    """Loss and inference of the diffusion policy.

    Attributes:
        prediction: What the network predicts: "v", the rate at which an action turns into noise, or the noise itself.
        sampler: "ddim" puts no new noise in, so that all chance lies in the first draw; "ddpm" does at every step but the last.
        steps: Steps from noise to action, of one evaluation of the network each [-].
        clip: Whether what the network takes for the clean action is brought into [-1, 1] at each step.
    """

    prediction: Literal["v", "epsilon"] = "v"
    sampler: Literal["ddim", "ddpm"] = "ddpm"
    steps: int = 16
    clip: bool = True

    def __post_init__(self) -> None:
        require_positive(self, "steps")


@dataclasses.dataclass(frozen=True, slots=True)
class FlowConfig:
    """Inference of the flow-matching policy.

    Attributes:
        integrator: "euler" evaluates the network once a step, "midpoint" twice and errs with the square of the step.
        steps: Steps from noise to action [-].
    """

    integrator: Literal["euler", "midpoint"] = "midpoint"
    steps: int = 8

    def __post_init__(self) -> None:
        require_positive(self, "steps")
