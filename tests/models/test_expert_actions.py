import pytest
import torch

from models.expert_actions import ExpertActions, thinned


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


def test_fewer_actions_are_evenly_over_the_demonstrations_and_keep_their_density():
    tensors = {
        "experts.actions": torch.arange(20.0).reshape(10, 2),
        "experts.density": torch.arange(10.0),
        "encoder.weight": torch.ones(12),
    }
    few = thinned(tensors, 4)
    assert few["experts.density"].tolist() == [0, 2, 5, 7]
    assert few["experts.actions"][:, 0].tolist() == [0, 4, 10, 14]
    assert few["encoder.weight"] is tensors["encoder.weight"]
    for most in (10, 11):
        assert torch.equal(thinned(tensors, most)["experts.density"], tensors["experts.density"])


def test_what_keeps_no_actions_stays_as_it_is():
    tensors = {"encoder.weight": torch.ones(12)}
    assert thinned(tensors, 4) == tensors
