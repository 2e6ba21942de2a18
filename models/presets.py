"""Named settings: `quick` takes minutes, `standard` is the default, `paper` has the numbers of the paper."""

import difflib
from collections.abc import Callable

from models.config import (
    METHODS,
    BetaConfig,
    CategoricalConfig,
    ChainConfig,
    DenoiserConfig,
    DensityConfig,
    DfoConfig,
    DiffusionConfig,
    FlowConfig,
    GridConfig,
    LangevinConfig,
    LangevinNegativesConfig,
    LearnerConfig,
    Method,
    MixtureConfig,
    NegativesConfig,
    NetworkConfig,
    OptimiserConfig,
    SamplerConfig,
)
from models.errors import SettingError


def quick(method: Method) -> LearnerConfig:
    """Settings that show the whole chain in minutes on two cores.

    Args:
        method: One of `METHODS`.

    Returns:
        `standard` with few epochs, few negatives and a coarse grid.
    """
    return _effective(method, epochs=5, negatives=64)


def standard(method: Method) -> LearnerConfig:
    """Settings that drive best within 40 minutes of training on two cores.

    Args:
        method: One of `METHODS`.

    Returns:
        A thirtieth of the paper's steps at thirty to eighty times its step size, blind to the previous action, with the energy
        corrected for its negatives and sampled exactly.
    """
    return _effective(method, epochs=12, negatives=128)


def _effective(method: Method, *, epochs: int, negatives: int) -> LearnerConfig:
    is_beta = method in {"bc-beta", "bc-mixture"}
    return LearnerConfig(
        method=method,
        network=NetworkConfig(state_inputs=("speed",), speed_scale=6.0, action_gain=16.0),
        beta=BetaConfig(
            beta_offset=1,
            label_noise=0.05,
            # One mode is the better of two sides; a mixture is there to take either.
            inference="sample" if method == "bc-mixture" else "mode",
        ),
        mixture=MixtureConfig(components=5),
        categorical=CategoricalConfig(points=65, smoothing=0.05, choice="sample"),
        denoiser=DenoiserConfig(width=128, action_gain=8.0, draws=16),
        diffusion=DiffusionConfig(prediction="v", sampler="ddpm", steps=16),
        flow=FlowConfig(integrator="midpoint", steps=8),
        negatives=NegativesConfig(
            # Chains of 25 steps cost as much as fifty negatives that are merely drawn.
            count=negatives // 8 if method == "ibc-langevin" else negatives,
            sigma=0.2,
            clip=False,
            uniform_share=0.5,
            correction="ranking",
        ),
        langevin_negatives=LangevinNegativesConfig(
            chain=ChainConfig(iterations=25), penalty_margin=10.0
        ),
        density=DensityConfig(weighting="none"),
        sampler=SamplerConfig(
            kind="grid",
            dfo=DfoConfig(num_samples=2048, temper=True),
            grid=GridConfig(points=65),
            langevin=LangevinConfig(num_chains=128, chain=ChainConfig(iterations=50)),
        ),
        optimiser=OptimiserConfig(
            # The likelihood of a narrow Beta has steep gradients: at 8e-4 the encoder of BC-Beta dies.
            learning_rate=3e-4 if is_beta else 8e-4,
            schedule="onecycle",
            epochs=epochs,
            gradient_clip=1.0 if is_beta else 10.0,
        ),
    )


def paper(method: Method) -> LearnerConfig:
    """The numbers of the paper; where it is silent, the literal or the likelier reading.

    Args:
        method: One of `METHODS`.

    Returns:
        Adam at 1e-5 for 400 epochs of minibatches of 128, 1024 negatives, search over 5 x 16384 candidates. Methods that
        the paper does not have take its optimiser, inputs and weights, and their own settings from `standard`.
    """
    ours = standard(method)
    return LearnerConfig(
        method=method,
        network=NetworkConfig(),
        beta=ours.beta
        if method == "bc-mixture"
        else BetaConfig(beta_offset=0, label_clamp=1e-7, inference="mode"),
        mixture=ours.mixture,
        categorical=ours.categorical,
        denoiser=ours.denoiser,
        diffusion=ours.diffusion,
        flow=ours.flow,
        # Chains find their negatives; 8 of them, and the lowest end to act with, are published.
        negatives=NegativesConfig(
            count=8 if method == "ibc-langevin" else 1024, sigma=0.22, clip=True
        ),
        density=DensityConfig(bandwidth=0.2, weighting="sampler"),
        sampler=SamplerConfig(
            kind="langevin" if method == "ibc-langevin" else "dfo",
            dfo=DfoConfig(num_samples=16384, iterations=5, sigma_init=0.5, shrink=0.5),
        ),
        optimiser=OptimiserConfig(learning_rate=1e-5, epochs=400, batch_size=128),
    )


PRESETS: dict[str, Callable[[Method], LearnerConfig]] = {
    "quick": quick,
    "standard": standard,
    "paper": paper,
}


def preset(name: str, method: str) -> LearnerConfig:
    """Settings by the name of their preset.

    Args:
        name: "quick", "standard" or "paper".
        method: One of `METHODS`.

    Returns:
        The settings.

    Raises:
        SettingError: If there is no such preset or method.
    """
    if name not in PRESETS:
        raise SettingError(_unknown("preset", name, tuple(PRESETS)))
    for known in METHODS:
        if known == method:
            return PRESETS[name](known)
    raise SettingError(_unknown("method", method, METHODS))


def _unknown(kind: str, name: str, known: tuple[str, ...]) -> str:
    near = difflib.get_close_matches(name, known, n=1)
    hint = f" Did you mean '{near[0]}'?" if near else ""
    return f"Unknown {kind} '{name}'. Known: {', '.join(known)}.{hint}"
