"""Data-augmented implicit behavioural cloning: the negatives are what the expert does elsewhere, disturbed."""

import torch
from jaxtyping import Float
from torch import Tensor

from models.ibc import IbcLearner
from models.interfaces import Batch
from models.negatives import mixed_negatives


class DaIbcLearner(IbcLearner):
    """IBC whose negatives are expert actions with Gaussian noise, so that they lie where actions are plausible."""

    def negatives(self, batch: Batch, *, generator: torch.Generator) -> Float[Tensor, "B N 2"]:
        """Disturbed actions of the minibatch, or of the whole data set, as the settings say [-]."""
        settings = self.config.negatives
        pool = batch.actions if settings.pool == "minibatch" else self.experts.actions
        return mixed_negatives(pool, len(batch.actions), settings, generator=generator)
