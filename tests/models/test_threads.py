import contextlib
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Iterator

import pytest
import torch

from models import presets
from models.learners import build_learner
from models.threads import _helpers, for_each, one_thread

# Powers of two cut many matrices into equal parts, which would hide what other numbers do.
THREAD_COUNTS = (1, 2, 3, 5, 7)

FORK = textwrap.dedent(
    """
    import os, signal, torch
    from models.threads import for_each, one_thread

    def act():
        torch.set_num_threads(2)
        with one_thread() as num_threads:
            for_each(range(4), lambda: lambda piece: torch.ones(3), num_threads=num_threads)

    act()
    child = os.fork()
    if child == 0:
        signal.alarm(20)  # ends a child that hangs
        act()
        print("the child is done", flush=True)
        os._exit(0)
    raise SystemExit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
    """
)


@contextlib.contextmanager
def threads(count: int) -> Iterator[None]:
    before = torch.get_num_threads()
    torch.set_num_threads(count)
    try:
        yield
    finally:
        torch.set_num_threads(before)


@pytest.mark.parametrize("preset", ["paper", "standard"])
@pytest.mark.parametrize("method", ["bc-beta", "da-ibc"])
def test_decisions_do_not_depend_on_the_number_of_threads(method, preset, batch, generator):
    learner = build_learner(presets.preset(preset, method), seed=0).eval()
    learner.prepare(batch.actions, torch.ones(len(batch.actions)))
    decisions = []
    for count in THREAD_COUNTS:
        generator.manual_seed(1)
        with threads(count):
            decisions.append(learner.act(batch.bev[:1], batch.state[:1], generator=generator))
            assert torch.get_num_threads() == count
    assert all(torch.equal(decisions[0], decision) for decision in decisions[1:])


@pytest.mark.parametrize("num_threads", [1, 2, 5])
@pytest.mark.parametrize("num_pieces", [1, 3, 100])
def test_every_piece_is_worked_on_once(num_threads, num_pieces):
    counts = torch.zeros(num_pieces)
    with one_thread():
        for_each(counts.split(1), lambda: lambda piece: piece.add_(1), num_threads=num_threads)
    assert (counts == 1).all()


def test_helpers_use_one_thread_and_keep_no_gradients():
    seen = []

    def worker():
        return lambda _: seen.append((torch.get_num_threads(), torch.is_grad_enabled()))

    with threads(3), one_thread() as num_threads:
        assert num_threads == 3
        for_each(range(50), worker, num_threads=num_threads)
    assert seen == [(1, False)] * 50


def test_helpers_use_one_thread_even_if_another_thread_set_more_meanwhile():
    """A thread takes over at its first operation what was set last in any thread."""
    seen = []

    def elsewhere():
        torch.set_num_threads(3)

    def worker():
        return lambda _: (seen.append(torch.get_num_threads()), time.sleep(0.01))

    _helpers.cache_clear()
    with threads(3), one_thread() as num_threads:
        other = threading.Thread(target=elsewhere)
        other.start()
        other.join()
        for_each(range(30), worker, num_threads=num_threads)
    assert seen == [1] * 30


def test_a_forked_process_that_acts_has_helpers_of_its_own(tmp_path):
    script = tmp_path / "fork.py"
    script.write_text(FORK)
    result = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, timeout=60, check=False
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout == "the child is done\n"


def test_an_error_in_a_piece_is_raised_and_threads_are_as_before():
    def broken(piece):
        raise ValueError(f"piece {piece}")

    with threads(3):
        with pytest.raises(ValueError, match="piece"), one_thread() as num_threads:
            for_each(range(9), lambda: broken, num_threads=num_threads)
        assert torch.get_num_threads() == 3
