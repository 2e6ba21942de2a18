import re

import pytest
import torch

from models.distributed import ALONE, Team, joined, sum_over, team_of
from models.errors import HardwareError, TrainingError
from models.learners import build_learner
from models.training import fit

WHOLE = {
    "RANK": "1",
    "LOCAL_RANK": "1",
    "WORLD_SIZE": "2",
    "MASTER_ADDR": "127.0.0.1",
    "MASTER_PORT": "29500",
}


@pytest.mark.parametrize("size", [1, 2, 3, 7])
@pytest.mark.parametrize("num", [0, 1, 2, 5, 128])
def test_parts_cover_a_minibatch_once_and_evenly(size, num):
    parts = [range(num)[Team(rank, size).part(num)] for rank in range(size)]
    assert [row for part in parts for row in part] == list(range(num))
    lengths = [len(part) for part in parts]
    assert max(lengths) - min(lengths) <= 1


def test_the_environment_of_torchrun_makes_a_team():
    team = team_of(WHOLE)
    assert team == Team(rank=1, size=2, local_rank=1)
    assert not team.leads
    assert team_of({"PATH": "/bin", "MASTER_ADDR": "127.0.0.1"}) == ALONE


@pytest.mark.parametrize("missing", list(WHOLE))
def test_half_an_environment_is_refused_by_what_is_missing(missing):
    half = {name: value for name, value in WHOLE.items() if name != missing}
    with pytest.raises(HardwareError, match=f"half of torchrun's: {missing} missing"):
        team_of(half)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("RANK", "one", "whole numbers"),
        ("RANK", "2", "RANK is 2"),
        ("WORLD_SIZE", "0", "WORLD_SIZE 0"),
    ],
)
def test_numbers_that_do_not_fit_together_are_refused(name, value, message):
    with pytest.raises(HardwareError, match=re.escape(message)):
        team_of({**WHOLE, name: value})


def test_more_processes_than_gpus_are_refused(monkeypatch):
    monkeypatch.setattr(torch.cuda, "device_count", lambda: 1)
    assert Team(0, 2, 0).device(torch.device("cuda")) == torch.device("cuda:0")
    assert Team(1, 2, 1).device(torch.device("cpu")) == torch.device("cpu")
    with pytest.raises(HardwareError, match="Process 2 of this machine has no GPU: there are 1"):
        Team(1, 2, 1).device(torch.device("cuda"))


def test_a_minibatch_smaller_than_the_team_is_refused(small_config, demonstrations):
    config = small_config("bc-beta", batch_size=2)
    with pytest.raises(TrainingError, match="3 processes share minibatches of 2 pairs"):
        fit(build_learner(config, seed=0), demonstrations, config, team=Team(0, 3))


def test_a_process_alone_needs_no_others():
    tensor = torch.ones(3)
    with joined(ALONE, torch.device("cpu")):
        sum_over(ALONE, [tensor])
    assert torch.equal(tensor, torch.ones(3))
