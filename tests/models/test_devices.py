"""Acting keeps to the device of the weights: on torch's device "meta", whose tensors have shapes and no numbers.

As on a GPU, products and sums with tensors of the CPU are refused there; what a kernel computes is not tested.
"""

import dataclasses

import pytest
import torch

from models import presets
from models.learners import build_learner

ELSEWHERE = torch.device("meta")


class Chance(torch.Generator):
    """Stands in for a generator of that device, which has none."""

    device = ELSEWHERE


@pytest.fixture
def _stand_ins(monkeypatch):
    def drawn(*shape, generator, **options):
        del generator
        return torch.empty(*shape, **options)

    monkeypatch.setattr(torch, "rand", drawn)
    monkeypatch.setattr(torch, "randn", drawn)
    monkeypatch.setattr(torch, "is_autocast_enabled", lambda device: False)


@pytest.mark.usefixtures("_stand_ins")
@pytest.mark.parametrize("precision", ["float32", "bfloat16"])
@pytest.mark.parametrize(
    ("method", "kind"),
    [
        ("da-ibc", "dfo"),
        ("da-ibc", "grid"),
        ("da-ibc", "langevin"),
        ("ibc-langevin", "langevin"),
        ("bc-beta", "grid"),
        ("bc-mixture", "grid"),
        ("bc-grid", "grid"),
        ("diffusion", "grid"),
        ("flow", "grid"),
    ],
)
def test_actions_are_chosen_where_the_weights_lie(method, kind, precision):
    config = presets.paper(method)
    sampler = dataclasses.replace(config.sampler, kind=kind, precision=precision)
    # Sampling a Beta takes its seed from the device as a number, of which this one has none.
    beta = dataclasses.replace(config.beta, inference="mode")
    learner = build_learner(dataclasses.replace(config, sampler=sampler, beta=beta), seed=0).eval()
    learner.prepare(torch.zeros(5, 2), torch.ones(5))
    learner.to(ELSEWHERE)
    bev = torch.zeros(1, 5, 192, 192, dtype=torch.uint8, device=ELSEWHERE)
    state = torch.zeros(1, 3, device=ELSEWHERE)
    assert learner.act(bev, state, generator=Chance()).device == ELSEWHERE
    with pytest.raises(RuntimeError, match="device"):
        learner.act(bev, torch.zeros(1, 3), generator=Chance())
