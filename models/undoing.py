"""What training tilted, as a function of the action alone, so that acting can take it out of a density again.

A policy trained on demonstrations weighed by w(y) learns w(y) p(y | x), and an energy trained against negatives of
density p_n learns that over p_n(y). Neither w nor p_n looks at the observation: log p_n - log w is one surface over the
box of actions. It is computed once, on a lattice finer than the kernels that it is a sum of, and read off by bilinear
interpolation.
"""

import torch
from jaxtyping import Float, Float64
from torch import Tensor

from models import lattice
from models.config import DensityConfig, LearnerConfig, NegativesConfig
from models.density import action_density, density_surface, inverse_weights
from models.interfaces import ACTION_BOUND, ACTION_SIZE


def surface(
    config: LearnerConfig, actions: Float[Tensor, "D 2"], density: Float[Tensor, " D"]
) -> Float[Tensor, "3 G G"]:
    """Compute what is to be added to a learnt log density.

    Args:
        config: What `sampler.undo` takes out, and how negatives and weights were made.
        actions: Every expert action trained on [-].
        density: Kernel density estimate at each of them [-].

    Returns:
        The sum [nats] and its slopes along acceleration and steering [nats], at G x G actions from -1 to 1.
    """
    axis = _axis(config, actions.device)
    total = axis.new_zeros(len(axis), len(axis))
    if config.sampler.undo in {"negatives", "both"}:
        total += _log_negatives(axis, config, actions, density)
    if config.sampler.undo in {"density", "both"}:
        total -= _log_weights(axis, config.density, actions, density)
    slopes = torch.gradient(total, spacing=float(axis[1] - axis[0]))
    return torch.stack((total, *slopes)).float()


def without_weights(
    log_density: Float[Tensor, "B N"],
    actions: Float[Tensor, "A N 2"],
    *,
    settings: DensityConfig,
    demonstrated: Float[Tensor, "D 2"],
) -> Float[Tensor, "B N"]:
    """Take the weights of the demonstrations out of a density of any method.

    Energies do this by themselves where `sampler.undo` says so; other methods do not remember the demonstrations.

    Args:
        log_density: What a learner trained with weights says of actions [nats].
        actions: These actions, for each observation or shared by all (A = 1) [-].
        settings: How the demonstrations were weighed.
        demonstrated: Every expert action trained on [-].

    Returns:
        Log of the density without weights, up to a constant of each observation [nats].
    """
    if settings.weighting == "none":
        return log_density
    axis = lattice.coordinates(settings.bandwidth, demonstrated.device)
    density = action_density(demonstrated, settings)
    weights = _log_weights(axis, settings, demonstrated, density).float()
    return log_density - lattice.read(weights[None], actions)[0]


def _axis(config: LearnerConfig, device: torch.device) -> Float64[Tensor, " G"]:
    """Coordinates of the lattice along either component [-]."""
    kernels = []
    if config.sampler.undo in {"negatives", "both"}:
        kernels.append(config.negatives.sigma)
    if config.sampler.undo in {"density", "both"}:
        kernels.append(config.density.bandwidth)
    return lattice.coordinates(min(kernels), device)


def _log_negatives(
    axis: Float64[Tensor, " G"],
    config: LearnerConfig,
    actions: Float[Tensor, "D 2"],
    density: Float[Tensor, " D"],
) -> Float64[Tensor, "G G"]:
    """Log density of the negatives of DA-IBC over all minibatches [nats]."""
    settings = config.negatives
    # A minibatch drawn by weight makes its negatives of what it drew.
    is_weighted = settings.pool == "minibatch" and config.density.weighting == "sampler"
    weights = inverse_weights(density, config.density) if is_weighted else torch.ones_like(density)
    share = _uniform_share(settings)
    mixture = lattice.mixture(axis, actions, weights, spread=settings.sigma)
    uniform = (2 * ACTION_BOUND) ** -ACTION_SIZE
    return ((1 - share) * mixture + share * uniform).clamp_min(lattice.LEAST_DENSITY).log()


def _uniform_share(settings: NegativesConfig) -> float:
    """Share of the uniform negatives, which are a whole number [-]."""
    return round(settings.uniform_share * settings.count) / settings.count


def _log_weights(
    axis: Float64[Tensor, " G"],
    settings: DensityConfig,
    actions: Float[Tensor, "D 2"],
    density: Float[Tensor, " D"],
) -> Float64[Tensor, "G G"]:
    """Log of the weight that a demonstration of each action has, up to a constant [nats]."""
    logs = -settings.exponent * density_surface(axis, actions, settings).log()
    if settings.cap is None:
        return logs
    mean = density.double().reciprocal().pow(settings.exponent).mean()
    return logs.clamp_max((settings.cap * mean).log())
