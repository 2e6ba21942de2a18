import pytest
import torch

from models.energy import EnergyHead


@pytest.fixture
def head():
    torch.manual_seed(0)
    return EnergyHead(16)


def test_late_fusion_equals_the_network_on_joined_vectors(head):
    features, actions = torch.randn(3, 16), torch.rand(3, 7, 2)
    joined = torch.cat((features[:, None].expand(-1, 7, -1), actions), dim=2)
    hidden = torch.relu(head.second(torch.relu(head.first(joined))))
    torch.testing.assert_close(head(features, actions), head.last(hidden).squeeze(-1))


def test_chunks_without_gradient_equal_one_piece_with_it(head):
    features, actions = torch.randn(3, 16), torch.rand(3, 5000, 2)
    with torch.no_grad():
        in_chunks = head(features, actions)
    torch.testing.assert_close(in_chunks, head(features, actions))


def test_shared_candidates_equal_repeated_ones(head):
    features, actions = torch.randn(3, 16), torch.rand(1, 9, 2)
    torch.testing.assert_close(head(features, actions), head(features, actions.repeat(3, 1, 1)))


def test_energies_stay_single_precision_under_autocast(head):
    with torch.autocast("cpu", torch.bfloat16):
        energies = head(torch.randn(2, 16), torch.rand(2, 4, 2))
    assert energies.dtype == torch.float32
