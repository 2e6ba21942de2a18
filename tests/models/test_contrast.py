import math

import pytest
import torch

from models import contrast
from models.contrast import contrastive_loss, info_nce
from models.energy import EnergyHead

B, N, F = 5, 9, 16


@pytest.fixture
def head():
    torch.manual_seed(0)
    return EnergyHead(F, action_gain=4.0)


@pytest.fixture
def inputs(generator):
    features = torch.randn(B, F, generator=generator).requires_grad_()
    candidates = 2 * torch.rand(B, N, 2, generator=generator) - 1
    offsets = torch.randn(B, N, generator=generator)
    weights = torch.rand(B, generator=generator)
    return features, candidates, offsets, weights


def plain(head, features, candidates, offsets, weights):
    """The loss as autograd sees it."""
    energies = head(features, candidates)
    energies = energies if offsets is None else energies + offsets
    losses = info_nce(energies[:, 0], energies[:, 1:])
    return (losses if weights is None else losses * weights).mean()


def gradients(head, features, loss):
    found = torch.autograd.grad(loss, [features, *head.parameters()])
    names = ["features", *(name for name, _ in head.named_parameters())]
    return dict(zip(names, found, strict=True))


@pytest.mark.parametrize("plainly", [True, False])
@pytest.mark.parametrize("observations_at_a_time", [1, 2, B])
def test_one_pass_gives_the_loss_and_the_gradients_of_autograd(
    head, inputs, plainly, observations_at_a_time, monkeypatch
):
    monkeypatch.setitem(contrast.ROWS_AT_A_TIME, "cpu", observations_at_a_time * N)
    features, candidates, offsets, weights = inputs
    if plainly:
        offsets = weights = None
    expected = plain(head, features, candidates, offsets, weights)
    loss = contrastive_loss(head, features, candidates, offsets=offsets, weights=weights)
    torch.testing.assert_close(loss, expected)
    found = gradients(head, features, 3 * loss)
    for name, gradient in gradients(head, features, 3 * expected).items():
        torch.testing.assert_close(found[name], gradient, rtol=1e-4, atol=1e-6, msg=name)


def test_the_gradient_of_the_last_bias_is_exactly_zero(head, inputs):
    features, candidates, _, _ = inputs
    loss = contrastive_loss(head, features, candidates)
    assert gradients(head, features, loss)["last.bias"] == 0


def test_gradients_in_bfloat16_are_as_near_to_float32_as_those_of_autograd(generator):
    torch.manual_seed(0)
    head = EnergyHead(256, action_gain=16.0)
    features = torch.randn(64, 256, generator=generator).requires_grad_()
    candidates = 2 * torch.rand(64, 100, 2, generator=generator) - 1
    exact = gradients(head, features, plain(head, features, candidates, None, None))
    with torch.autocast("cpu", torch.bfloat16):
        ours = contrastive_loss(head, features, candidates)
        theirs = plain(head, features, candidates, None, None)
    errors = []
    for loss in (ours, theirs):
        found = gradients(head, features, loss)
        # The last bias has no gradient but for rounding.
        names = [name for name in exact if name != "last.bias"]
        errors.append([float((found[n] - exact[n]).norm() / exact[n].norm()) for n in names])
    assert all(our <= 1.3 * their for our, their in zip(*errors, strict=True)), errors
    assert max(errors[0]) < 0.3


def test_without_gradients_the_loss_is_the_same(head, inputs):
    features, candidates, offsets, weights = inputs
    with_gradients = contrastive_loss(head, features, candidates, offsets=offsets, weights=weights)
    with torch.no_grad():
        without = contrastive_loss(head, features, candidates, offsets=offsets, weights=weights)
    torch.testing.assert_close(without, with_gradients.detach())


def test_info_nce_is_the_closed_form():
    positive, negatives = torch.tensor([0.5, -1.0]), torch.tensor([[1.0, 2.0], [0.0, 0.3]])
    expected = []
    for energy, others in zip(positive.tolist(), negatives.tolist(), strict=True):
        top = math.exp(-energy)
        expected.append(-math.log(top / (top + sum(math.exp(-other) for other in others))))
    torch.testing.assert_close(info_nce(positive, negatives), torch.tensor(expected))


def test_info_nce_of_a_flat_energy_is_the_log_of_the_number_of_candidates():
    loss = info_nce(torch.zeros(3), torch.zeros(3, 255))
    torch.testing.assert_close(loss, torch.full((3,), math.log(256)))
