"""Behavioural cloning with a Beta distribution over each action."""

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
from models.samplers.grid import draw_points
from models.threads import one_thread


class BcBetaLearner(Learner):
    """Explicit and unimodal: an observation gives the two concentrations of each action."""

    def __init__(self, config: LearnerConfig) -> None:
        super().__init__()
        self.config = config
        self.encoder = Encoder(config.network)
        self.head = policy_head(self.encoder.feature_size)
        self.alpha = nn.Linear(HIDDEN_SIZE, ACTION_SIZE)
        self.beta = nn.Linear(HIDDEN_SIZE, ACTION_SIZE)

    def distribution(self, bev: UInt8[Tensor, "B C H W"], state: Float[Tensor, "B 3"]) -> Beta:
        """Distribution of the actions rescaled to [0, 1] [-], in single precision."""
        hidden = self.head(self.encoder(bev, state))
        alpha, beta = (
            F.softplus(layer(hidden).float())
            + self.config.beta.beta_offset
            + SMALLEST_CONCENTRATION
            for layer in (self.alpha, self.beta)
        )  # (B, 2) each
        return Beta(alpha, beta, validate_args=False)

    def draw(self, actions: Float[Tensor, "B 2"], *, generator: torch.Generator) -> Chance:
        """Draw dropout, and noise on the labels where the settings ask for it."""
        probability = self.config.network.state_dropout
        kept = draw_dropout(len(actions), probability, generator=generator)
        noise = draw_label_noise(actions, self.config.beta.label_noise, generator=generator)
        return Chance(keeps_previous=kept, label_noise=noise)

    def loss(
        self, batch: Batch, chance: Chance, *, weights: Float[Tensor, " B"] | None
    ) -> Float[Tensor, ""]:
        """Mean negative log-likelihood of the expert actions, less the entropy bonus [nats]."""
        settings = self.config.beta
        state = drop_previous_action(batch.state, chance.keeps_previous)
        distribution = self.distribution(batch.bev, state)
        labels = noisy_units(batch.actions, chance.label_noise, label_clamp=settings.label_clamp)
        losses = -distribution.log_prob(labels).sum(dim=1)  # (B,)
        if settings.entropy_bonus > 0:
            losses = losses - settings.entropy_bonus * distribution.entropy().sum(dim=1)
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
        """Mode, mean or a sample of the distribution, as the settings say."""
        with one_thread():
            distribution = self.distribution(bev, state)
        alpha, beta = distribution.concentration1, distribution.concentration0
        if self.config.beta.inference == "mode":
            unit = beta_mode(alpha, beta)
        elif self.config.beta.inference == "mean":
            unit = distribution.mean
        elif commitment is not None:
            each = log_cell_masses(alpha, beta)  # (B, 2, P)
            masses = (each[:, 0, :, None] + each[:, 1, None, :]).flatten(1)
            return draw_points(masses, generator=generator, commitment=commitment)
        else:
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
            found = self.distribution(bev, state)
        alpha, beta = found.concentration1[:, None], found.concentration0[:, None]  # (B, 1, 2)
        unit = unit_from_action(actions, label_clamp=self.config.beta.label_clamp)
        log_unit = Beta(alpha, beta, validate_args=False).log_prob(unit).sum(dim=-1)  # (B, N)
        return log_unit - ACTION_SIZE * math.log(2)  # an action is twice as wide as its unit
