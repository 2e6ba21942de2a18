"""What training tilted, as a function of the action alone, so that acting can take it out of a density again.

A policy trained on demonstrations weighed by w(y) learns w(y) p(y | x), and an energy trained against negatives of
density p_n learns that over p_n(y). Neither w nor p_n looks at the observation: log p_n - log w is one surface over the
box of actions. It is computed once, on a lattice finer than the kernels that it is a sum of, and read off by bilinear
interpolation.
"""

import math

import torch
from jaxtyping import Float, Float64
from torch import Tensor
from torch.nn import functional as F  # noqa: N812

from models.config import DensityConfig, LearnerConfig, NegativesConfig
from models.density import action_density, inverse_weights
from models.interfaces import ACTION_BOUND, ACTION_SIZE

# Between lattice points of a Gaussian the interpolated logarithm is off by 1 / (8 * 16^2), 0.0005 nats.
POINTS_A_KERNEL = 16
MOST_POINTS = 1025
# Far from all kernels a density is nothing; its logarithm stays a number.
LEAST_DENSITY = 1e-300
CENTRES_AT_A_TIME = 4096


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
    axis = _lattice(settings.bandwidth, demonstrated.device)
    density = action_density(demonstrated, settings)
    weights = _log_weights(axis, settings, demonstrated, density).float()
    return log_density - read(weights[None], actions)[0]


def read(
    surface: Float[Tensor, "C G G"], actions: Float[Tensor, "A N 2"]
) -> Float[Tensor, "C A N"]:
    """All channels of a surface at actions in [-1, 1] [nats]."""
    # grid_sample wants the index that runs fastest first.
    places = actions.flip(-1)[None] / ACTION_BOUND
    found = F.grid_sample(surface[None], places, padding_mode="border", align_corners=True)
    return found[0]


def _axis(config: LearnerConfig, device: torch.device) -> Float64[Tensor, " G"]:
    """Coordinates of the lattice along either component [-]."""
    kernels = []
    if config.sampler.undo in {"negatives", "both"}:
        kernels.append(config.negatives.sigma)
    if config.sampler.undo in {"density", "both"}:
        kernels.append(config.density.bandwidth)
    return _lattice(min(kernels), device)


def _lattice(kernel: float, device: torch.device) -> Float64[Tensor, " G"]:
    """Coordinates from -1 to 1 that are dense enough for kernels of a standard deviation [-]."""
    points = min(1 + math.ceil(2 * ACTION_BOUND * POINTS_A_KERNEL / kernel), MOST_POINTS)
    return torch.linspace(-ACTION_BOUND, ACTION_BOUND, points, dtype=torch.float64, device=device)


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
    mixture = _mixture(axis, actions, weights, spread=settings.sigma)
    uniform = (2 * ACTION_BOUND) ** -ACTION_SIZE
    return ((1 - share) * mixture + share * uniform).clamp_min(LEAST_DENSITY).log()


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
    ones = torch.ones_like(density)
    if settings.kind == "joint":
        estimate = _mixture(axis, actions, ones, spread=settings.bandwidth)
    else:
        rows, columns = (
            _kernels(axis, component, settings.bandwidth).mean(dim=1) for component in actions.T
        )
        estimate = rows[:, None] * columns
    logs = -settings.exponent * estimate.clamp_min(LEAST_DENSITY).log()
    if settings.cap is None:
        return logs
    mean = density.double().reciprocal().pow(settings.exponent).mean()
    return logs.clamp_max((settings.cap * mean).log())


def _mixture(
    axis: Float64[Tensor, " G"],
    centres: Float[Tensor, "D 2"],
    weights: Float[Tensor, " D"],
    *,
    spread: float,
) -> Float64[Tensor, "G G"]:
    """Density of Gaussians around centres on a lattice: each is a product of two, so the sum is a matrix product."""
    total = axis.new_zeros(len(axis), len(axis))
    for part, part_weights in zip(
        centres.split(CENTRES_AT_A_TIME), weights.split(CENTRES_AT_A_TIME), strict=True
    ):
        rows, columns = (_kernels(axis, component, spread) for component in part.T)
        total.addmm_(rows * part_weights, columns.T)
    return total / weights.double().sum()


def _kernels(
    axis: Float64[Tensor, " G"], centres: Float[Tensor, " D"], spread: float
) -> Float64[Tensor, "G D"]:
    """One-dimensional Gaussian densities of standard deviation `spread` around centres [-]."""
    distances = (axis[:, None] - centres.double()) / spread
    return distances.square_().mul_(-0.5).exp_() / (spread * math.sqrt(2 * math.pi))
