import pytest
import torch

from models.expert_actions import ExpertActions


@pytest.fixture
def experts():
    experts = ExpertActions()
    experts.remember(torch.tensor([[-1.0, 0.0], [0.5, 0.5]]), torch.tensor([4.0, 1.0]))
    return experts


@pytest.mark.parametrize(("start", "share_rare"), [("inverse_kde", 0.8), ("kde", 0.2)])
def test_a_search_starts_from_expert_actions_by_their_density(
    start, share_rare, experts, generator
):
    drawn = experts.draw(3, 4000, start, generator=generator)
    assert drawn.shape == (3, 4000, 2)
    is_rare = (drawn == torch.tensor([0.5, 0.5])).all(dim=-1)
    assert is_rare.float().mean(dim=1).tolist() == pytest.approx([share_rare] * 3, abs=0.03)


def test_a_uniform_start_needs_no_expert(generator):
    drawn = ExpertActions().draw(1, 5000, "uniform", generator=generator)
    assert drawn.mean().item() == pytest.approx(0, abs=0.03)


def test_an_empty_one_loads_as_many_actions_as_were_saved(experts):
    fresh = ExpertActions()
    fresh.load_state_dict(experts.state_dict())
    assert torch.equal(fresh.actions, experts.actions)
    assert torch.equal(fresh.density, experts.density)
