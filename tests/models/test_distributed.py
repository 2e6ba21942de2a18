import datetime
import re
import socket

import pytest
import torch

from models import distributed
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
        ("MASTER_PORT", "abc", "MASTER_PORT is 'abc'"),
        ("MASTER_PORT", "70000", "from 1 to 65535"),
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


def test_one_gpu_for_several_processes_is_refused_and_not_replaced():
    assert ALONE.device(torch.device("cuda:1")) == torch.device("cuda:1")
    with pytest.raises(HardwareError, match="'cuda:1' is one GPU, and 2 processes take one each"):
        Team(0, 2, 0).device(torch.device("cuda:1"))


def test_an_address_where_nobody_answers_is_given_up_soon(monkeypatch):
    with socket.socket() as closed:  # bound and not listening
        closed.bind(("127.0.0.1", 0))
        for name, value in {**WHOLE, "MASTER_PORT": str(closed.getsockname()[1])}.items():
            monkeypatch.setenv(name, value)
        assert datetime.timedelta(minutes=1) >= distributed.JOINING
        monkeypatch.setattr(distributed, "JOINING", datetime.timedelta(seconds=1))
        with (
            pytest.raises(HardwareError, match="Process 1 of 2 cannot reach the others") as refusal,
            joined(team_of(WHOLE), torch.device("cpu")),
        ):
            pytest.fail("nobody was there to join")
    assert "\n" not in str(refusal.value)


def test_a_process_that_loses_another_says_so_and_what_to_do(monkeypatch):
    def lost(*_):
        raise RuntimeError("[pair.cc:546] Connection closed by peer [127.0.0.1]:4711\nstack")

    monkeypatch.setattr(torch.distributed, "all_reduce", lost)
    with pytest.raises(
        HardwareError, match=r"Process 0 of 2 has lost another: .*:4711. What"
    ) as told:
        sum_over(Team(0, 2), [torch.ones(2)])
    assert "--resume" in str(told.value)
    assert "stack" not in str(told.value)


def test_a_minibatch_smaller_than_the_team_is_refused(small_config, demonstrations):
    config = small_config("bc-beta", batch_size=2)
    with pytest.raises(TrainingError, match="3 processes share minibatches of 2 pairs"):
        fit(build_learner(config, seed=0), demonstrations, config, team=Team(0, 3))


def test_a_process_alone_needs_no_others():
    tensor = torch.ones(3)
    with joined(ALONE, torch.device("cpu")):
        sum_over(ALONE, [tensor])
    assert torch.equal(tensor, torch.ones(3))
