"""Behavioural cloning with a mixture of Beta distributions: explicit, with as many modes as components."""

import math

import torch
from jaxtyping import Float, UInt8
from torch import Tensor, nn
from torch.distributions import Beta
from torch.nn import functional as F  # noqa: N812

from models.beta_density import (
    SMALLEST_CONCENTRATION,
    beta_mode,
    draw_beta,
    draw_label_noise,
    log_cell_masses,
    noisy_units,
    unit_from_action,
)
from models.config import LearnerConfig
from models.encoder import HIDDEN_SIZE, Encoder, draw_dropout, drop_previous_action, policy_head
from models.interfaces import ACTION_SIZE, Batch, Chance, Learner, weighted_mean
from models.samplers.commitment import Commitment
from models.samplers.draws import draw_categorical, pick
from models.samplers.grid import draw_points
from models.threads import one_thread

LEAST_CONCENTRATION = 5.0
"""Smallest sum of both concentrations of a component, a standard deviation of at most 0.41 in [-1, 1] [-].

What is broader is for several components to cover. With concentrations that were softplus of what the network said, one of them
became uniform and stayed so, and drives coasted through red lights (docs/notes.md).
"""


class BcMixtureLearner(Learner):
    """Explicit and multimodal: p(y | x) is a weighted sum of products of two Beta densities.

    The network tells of each where its peak is (with `beta_offset` 0 its mean) and how sharp it is, not the concentrations, so
    that there is a broadest one (`LEAST_CONCENTRATION`) and a slope that leads away from it.

    Reference:
        Bishop, Mixture Density Networks, 1994.
    """

    def __init__(self, config: LearnerConfig) -> None:
        super().__init__()
        self.config = config
        num = config.mixture.components
        self.encoder = Encoder(config.network)
        self.head = policy_head(self.encoder.feature_size)
        self.weights = nn.Linear(HIDDEN_SIZE, num)
        self.peaks = nn.Linear(HIDDEN_SIZE, num * ACTION_SIZE)
        self.sharpness = nn.Linear(HIDDEN_SIZE, num * ACTION_SIZE)
        with torch.no_grad():
            self.peaks.bias.copy_(torch.logit(_spread_points(num)).flatten())
            self.sharpness.bias.zero_()

    def mixture(
        self, bev: UInt8[Tensor, "B C H W"], state: Float[Tensor, "B 3"]
    ) -> tuple[Float[Tensor, "B K"], Beta]:
        """Log weights [nats], and distributions (B, K, 2) of actions rescaled to [0, 1] [-], in single precision."""
        hidden = self.head(self.encoder(bev, state))
        log_weights = F.log_softmax(self.weights(hidden).float(), dim=1)  # (B, K)
        peaks, raw = (
            layer(hidden).float().unflatten(1, (-1, ACTION_SIZE))
            for layer in (self.peaks, self.sharpness)
        )  # (B, K, 2) each
        offset = self.config.beta.beta_offset + SMALLEST_CONCENTRATION
        shared = LEAST_CONCENTRATION + squareplus(raw) - 2 * offset
        alpha, beta = offset + shared * peaks.sigmoid(), offset + shared * (-peaks).sigmoid()
        return log_weights, Beta(alpha, beta, validate_args=False)

    def draw(self, actions: Float[Tensor, "B 2"], *, generator: torch.Generator) -> Chance:
        """Draw dropout, and noise on the labels where the settings ask for it."""
        probability = self.config.network.state_dropout
        kept = draw_dropout(len(actions), probability, generator=generator)
        noise = draw_label_noise(actions, self.config.beta.label_noise, generator=generator)
        return Chance(keeps_previous=kept, label_noise=noise)

    def loss(
        self, batch: Batch, chance: Chance, *, weights: Float[Tensor, " B"] | None
    ) -> Float[Tensor, ""]:
        """Mean negative log-likelihood of the expert actions [nats]."""
        clamp = self.config.beta.label_clamp
        state = drop_previous_action(batch.state, chance.keeps_previous)
        log_weights, components = self.mixture(batch.bev, state)
        labels = noisy_units(batch.actions, chance.label_noise, label_clamp=clamp)
        losses = -mixture_log_prob(log_weights, components, labels[:, None]).squeeze(1)  # (B,)
        return weighted_mean(losses, weights)

    @torch.no_grad()
    def act(
        self,
        bev: UInt8[Tensor, "B C H W"],
        state: Float[Tensor, "B 3"],
        *,
        generator: torch.Generator,
        commitment: Commitment | None = None,
    ) -> Float[Tensor, "B 2"]:
        """Mode, mean or a sample of the mixture, as the settings say."""
        with one_thread():
            log_weights, components = self.mixture(bev, state)
        if self.config.beta.inference == "mode":
            unit = mixture_mode(log_weights, components, self.config.beta.label_clamp)
        elif self.config.beta.inference == "mean":
            unit = (log_weights.exp()[..., None] * components.mean).sum(dim=1)
        elif commitment is not None:
            masses = mixture_log_masses(log_weights, components).flatten(1)
            return draw_points(masses, generator=generator, commitment=commitment)
        else:
            drawn = draw_categorical(log_weights.exp(), 1, generator=generator)  # (B, 1)
            alpha, beta = (
                pick(each, drawn).squeeze(1)
                for each in (components.concentration1, components.concentration0)
            )
            unit = draw_beta(alpha, beta, generator=generator)
        return 2 * unit - 1

    @torch.no_grad()
    def log_density(
        self,
        bev: UInt8[Tensor, "B C H W"],
        state: Float[Tensor, "B 3"],
        actions: Float[Tensor, "A N 2"],
    ) -> Float[Tensor, "B N"]:
        """Log of the density of actions, in closed form; at the ends, that of the clamped label [nats]."""
        with one_thread():
            log_weights, components = self.mixture(bev, state)
        unit = unit_from_action(actions, label_clamp=self.config.beta.label_clamp)
        log_unit = mixture_log_prob(log_weights, components, unit)
        return log_unit - ACTION_SIZE * math.log(2)  # an action is twice as wide as its unit


def squareplus(raw: Float[Tensor, "*B"]) -> Float[Tensor, "*B"]:
    """Make numbers positive as softplus does, but with a slope that fades with the square of the distance, not exponentially.

    Args:
        raw: Any numbers [-].

    Returns:
        Positive numbers, 1 for 0 [-].

    Reference:
        Barron, Squareplus: A Softplus-Like Algebraic Rectifier, 2021.
    """
    root = torch.sqrt(raw * raw + 4)
    # Far below zero the sum would lose its digits.
    return torch.where(raw > 0, (raw + root) / 2, 2 / (root - raw.clamp(max=0)))


def mixture_log_prob(
    log_weights: Float[Tensor, "B K"], components: Beta, unit: Float[Tensor, "A N 2"]
) -> Float[Tensor, "B N"]:
    """Log density of a mixture at some points.

    Args:
        log_weights: Of the components [nats].
        components: Their distributions, of batch shape (B, K, 2).
        unit: Points of each observation, or one set (A = 1) for all, in (0, 1) [-].

    Returns:
        Log density over the unit square [nats].
    """
    alpha, beta = components.concentration1[:, None], components.concentration0[:, None]
    each = Beta(alpha, beta, validate_args=False).log_prob(unit[:, :, None])  # (B, N, K, 2)
    return torch.logsumexp(log_weights[:, None] + each.sum(dim=-1), dim=2)


def mixture_log_masses(
    log_weights: Float[Tensor, "B K"], components: Beta
) -> Float[Tensor, "B P P"]:
    """Log probability of the cells of a grid over the unit square, acceleration first [nats]."""
    each = log_cell_masses(components.concentration1, components.concentration0)  # (B, K, 2, P)
    acceleration = each[:, :, 0] + log_weights[..., None]
    return torch.logsumexp(acceleration[..., None] + each[:, :, 1, None, :], dim=1)


def mixture_mode(
    log_weights: Float[Tensor, "B K"], components: Beta, label_clamp: float
) -> Float[Tensor, "B 2"]:
    """The mode of that component where the mixture is densest, in [0, 1] [-].

    A component with a peak at an end has no bound there, so densities are compared as far from it as labels are.
    """
    modes = beta_mode(components.concentration1, components.concentration0)  # (B, K, 2)
    inside = modes.clamp(label_clamp, 1 - label_clamp)
    densest = mixture_log_prob(log_weights, components, inside).argmax(dim=1, keepdim=True)
    return pick(modes, densest).squeeze(1)


def _spread_points(num: int) -> Float[Tensor, "K 2"]:
    """First peaks of the components, evenly over the unit square: those that start alike would stay alike [-].

    Reference:
        Roberts, The Unreasonable Effectiveness of Quasirandom Sequences, 2018: points that fill a square evenly.
    """
    plastic = 1.324717957244746
    steps = torch.tensor([1 / plastic, 1 / plastic**2])
    return 0.05 + 0.9 * ((0.5 + torch.arange(num)[:, None] * steps) % 1)
