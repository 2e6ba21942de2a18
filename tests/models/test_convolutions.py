import pytest
import torch
from torch import Tensor

from models.convolutions import FLAT_SIZE, LAYERS, Convolutions


@pytest.fixture
def bev(generator) -> Tensor:
    return torch.randint(0, 256, (2, 5, 192, 192), generator=generator, dtype=torch.uint8)


def results(network, look) -> list[Tensor]:
    network.zero_grad()
    result = look()
    (result * torch.linspace(-1, 1, FLAT_SIZE, dtype=result.dtype)).sum().backward()
    return [result.detach(), *(it.grad.clone() for it in network.parameters())]


def test_convolutions_over_blocks_equal_those_over_pixels(bev):
    network = Convolutions().double()
    ours = results(network, lambda: network.in_blocks(bev, torch.float64))
    theirs = results(network, lambda: network(bev, torch.float64))
    assert len(ours) == 1 + 2 * len(LAYERS)
    for mine, plain in zip(ours, theirs, strict=True):
        assert plain.abs().max() > 0
        torch.testing.assert_close(mine, plain)


def test_views_that_are_strided_in_memory_are_looked_at_alike(bev):
    network = Convolutions().double()
    strided = bev.contiguous(memory_format=torch.channels_last)
    looked = network.in_blocks(strided, torch.float64)
    torch.testing.assert_close(looked, network.in_blocks(bev, torch.float64), rtol=0, atol=0)


@pytest.mark.parametrize(
    ("dtype", "trains", "is_used"),
    [
        (torch.bfloat16, True, True),
        (torch.bfloat16, False, False),  # one picture at a time, where copies cost nothing
        (torch.float32, True, False),
    ],
)
def test_blocks_are_used_only_where_they_are_quicker(dtype, trains, is_used, bev, monkeypatch):
    used, in_blocks = [], Convolutions.in_blocks
    monkeypatch.setattr(
        Convolutions,
        "in_blocks",
        lambda self, *given: used.append(given) or in_blocks(self, *given),
    )
    network = Convolutions().to(dtype)
    with torch.set_grad_enabled(trains):
        assert network(bev, dtype).shape == (2, FLAT_SIZE)
    assert bool(used) == is_used
