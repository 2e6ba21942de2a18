import pytest
import torch

from models.denoiser import Denoiser


@pytest.fixture
def denoiser() -> Denoiser:
    torch.manual_seed(0)
    return Denoiser(16, width=32, action_gain=4.0).double()


def test_the_divergence_is_the_trace_of_the_derivative(denoiser):
    observed = denoiser.observation(torch.randn(1, 16).double())
    noisy = torch.randn(7, 2).double()
    value, divergence = denoiser.with_divergence(observed, noisy, 0.3)
    torch.testing.assert_close(value, denoiser(observed[None], noisy[None], 0.3)[0])
    for index, point in enumerate(noisy):
        derivative = torch.autograd.functional.jacobian(
            lambda x: denoiser(observed[None], x[None, None], 0.3)[0, 0], point
        )
        torch.testing.assert_close(divergence[index], derivative.diagonal().sum())


def test_each_action_has_its_own_time_and_observation(denoiser):
    denoiser.float()
    observed = denoiser.observe(torch.randn(2, 16))
    noisy, times = torch.randn(2, 3, 2), torch.rand(2, 3)
    together = denoiser(observed, noisy, times)
    alone = denoiser(observed[[1]], noisy[1:, 2:], float(times[1, 2]))
    torch.testing.assert_close(together[1, 2], alone[0, 0])


def test_it_is_never_autocast():
    torch.manual_seed(0)
    denoiser = Denoiser(16, width=32)
    features, noisy = torch.randn(1, 16), torch.randn(1, 3, 2)
    plain = denoiser(denoiser.observe(features), noisy, 0.5)
    with torch.autocast("cpu", torch.bfloat16):
        cast = denoiser(denoiser.observe(features), noisy, 0.5)
    assert torch.equal(plain, cast)
