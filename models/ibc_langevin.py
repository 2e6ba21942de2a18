"""Implicit behavioural cloning against negatives that walk to where the energy is low, with a gradient penalty."""

import torch
from jaxtyping import Float
from torch import Tensor

from models.contrast import contrastive_loss
from models.encoder import drop_previous_action
from models.energy_slopes import EnergySlopes
from models.ibc import IbcLearner
from models.interfaces import Batch, Chance, weighted_mean
from models.samplers.langevin import draw_noise, walk


class LangevinIbcLearner(IbcLearner):
    """IBC whose negatives are the ends of Langevin chains on the energy as it is: where it wrongly is low, it is raised.

    Reference:
        Florence et al., Implicit Behavioral Cloning, CoRL 2022, and its published code.
    """

    def draw(self, actions: Float[Tensor, "B 2"], *, generator: torch.Generator) -> Chance:
        """Draw dropout, where the chains begin, and the noise of all their steps."""
        chance = super().draw(actions, generator=generator)
        noise = draw_noise(
            len(actions),
            self.config.negatives.count - self._num_still,
            self.config.langevin_negatives.chain,
            generator=generator,
        )
        return chance._replace(chain_noise=noise)

    @property
    def _num_still(self) -> int:
        """How many negatives of an observation stay where they are drawn, uniformly."""
        return round(self.config.negatives.uniform_share * self.config.negatives.count)

    def loss(
        self, batch: Batch, chance: Chance, *, weights: Float[Tensor, " B"] | None
    ) -> Float[Tensor, ""]:
        """Mean InfoNCE loss against the ends of the chains, and the gradient penalty there and at the expert [nats]."""
        settings = self.config.langevin_negatives
        state = drop_previous_action(batch.state, chance.keeps_previous)
        features = self.encoder(batch.bev, state)
        with torch.autocast(features.device.type, enabled=False):
            negatives = self._walked(features.detach(), chance)
        candidates = torch.cat((batch.actions[:, None], negatives), dim=1)  # (B, 1 + N, 2)
        loss = contrastive_loss(self.energy, features, candidates, weights=weights)
        if settings.penalty_weight == 0:
            return loss
        with torch.autocast(features.device.type, enabled=False):
            slopes = EnergySlopes(self.energy, features.detach())(candidates)
        penalties = gradient_penalty(slopes, margin=settings.penalty_margin)
        return loss + settings.penalty_weight * weighted_mean(penalties, weights)

    def _walked(self, features: Float[Tensor, "B F"], chance: Chance) -> Float[Tensor, "B N 2"]:
        """Negatives at the ends of chains, through which no gradient goes back [-]."""
        assert chance.negatives is not None, "draw() gives them"
        assert chance.chain_noise is not None, "draw() gives it"
        still, start = chance.negatives.tensor_split([self._num_still], dim=1)
        with torch.no_grad():
            slopes = EnergySlopes(self.energy, features, self.config.optimiser.precision)
        chain = self.config.langevin_negatives.chain
        return torch.cat((still, walk(slopes, start, chance.chain_noise, chain)), dim=1)


def gradient_penalty(slopes: Float[Tensor, "B N 2"], *, margin: float) -> Float[Tensor, " B"]:
    """Mean over candidates of max(0, |dE/dy| - margin)^2, with the largest component for the norm.

    Args:
        slopes: dE/dy at each candidate [nats].
        margin: Slope without penalty [nats].

    Returns:
        The penalty of each observation [-].

    Reference:
        Florence et al., Implicit Behavioral Cloning, CoRL 2022: at the last step of the chains alone.
    """
    return (slopes.abs().amax(dim=-1) - margin).clamp_min(0).square().mean(dim=1)
