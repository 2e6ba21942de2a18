"""Data-augmented implicit behavioural cloning: the negatives are what the expert does elsewhere, disturbed."""

import torch
from jaxtyping import Float
from torch import Tensor

from models.ibc import IbcLearner
from models.interfaces import Batch
from models.negatives import log_density, mixed_negatives


class DaIbcLearner(IbcLearner):
    """IBC whose negatives are expert actions with Gaussian noise, so that they lie where actions are plausible."""

    def negatives(self, batch: Batch, *, generator: torch.Generator) -> Float[Tensor, "B N 2"]:
        """Disturbed actions of the minibatch, or of the whole data set, as the settings say [-]."""
        return mixed_negatives(
            self._pool(batch), len(batch.actions), self.config.negatives, generator=generator
        )

    def log_negative_density(
        self, batch: Batch, candidates: Float[Tensor, "B N 2"]
    ) -> Float[Tensor, "B N"] | None:
        """Density of the negatives where the settings correct for it [nats].

        Without it the energy learns log p(y | x) - log p_n(y): what the expert often does anywhere looks worse than
        it is.
        """
        settings = self.config.negatives
        if settings.correction == "none":
            return None
        return log_density(candidates, self._pool(batch), settings)

    def _pool(self, batch: Batch) -> Float[Tensor, "P 2"]:
        """Expert actions that the negatives are made from."""
        if self.config.negatives.pool == "minibatch":
            return batch.actions
        return self.experts.actions
