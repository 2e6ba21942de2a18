import dataclasses

import pytest
import torch

from models.da_ibc import DaIbcLearner


@pytest.mark.parametrize("pool", ["minibatch", "dataset"])
def test_negatives_come_from_the_pool_of_the_settings(pool, small_config, batch, generator):
    config = small_config("da-ibc")
    negatives = dataclasses.replace(config.negatives, pool=pool, sigma=0.0, count=50)
    learner = DaIbcLearner(dataclasses.replace(config, negatives=negatives))
    learner.prepare(torch.tensor([[0.125, 0.25]]), torch.ones(1))
    drawn = learner.draw(batch.actions, generator=generator).negatives
    expected = batch.actions if pool == "minibatch" else torch.tensor([[0.125, 0.25]])
    assert drawn.shape == (len(batch.actions), 50, 2)
    assert (drawn[:, :, None] == expected).all(dim=-1).any(dim=-1).all()
