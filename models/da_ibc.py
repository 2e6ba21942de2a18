"""Data-augmented implicit behavioural cloning: the negatives are what the expert does elsewhere, disturbed."""

import torch
from jaxtyping import Float
from torch import Tensor

from models.ibc import IbcLearner
from models.negatives import log_density, mixed_negatives


class DaIbcLearner(IbcLearner):
    """IBC whose negatives are expert actions with Gaussian noise, so that they lie where actions are plausible."""

    def pool(self, actions: Float[Tensor, "B 2"]) -> Float[Tensor, "P 2"]:
        """Actions of the minibatch, or of the whole data set, as the settings say [-]."""
        return actions if self.config.negatives.pool == "minibatch" else self.experts.actions

    def negatives(
        self, num_observations: int, pool: Float[Tensor, "P 2"], *, generator: torch.Generator
    ) -> Float[Tensor, "B N 2"]:
        """Disturbed actions of the pool [-]."""
        return mixed_negatives(pool, num_observations, self.config.negatives, generator=generator)

    def log_negative_density(
        self, candidates: Float[Tensor, "B N 2"], pool: Float[Tensor, "P 2"]
    ) -> Float[Tensor, "B N"] | None:
        """Density of the negatives where the settings correct for it [nats].

        Without it the energy learns log p(y | x) - log p_n(y): what the expert often does anywhere looks worse than
        it is.
        """
        settings = self.config.negatives
        if settings.correction == "none":
            return None
        return log_density(candidates, pool, settings)
