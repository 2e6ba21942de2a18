"""Work in pieces on several threads, so that the bytes of the results do not hang on their number.

torch cuts each of its operations up among threads, which then wait for each other: a decision of a policy is a thousand
small operations, so on a busy machine it waits longer than it computes, and sums are rounded according to how they
were cut. Here every operation is done by one thread, and threads share out pieces of a fixed size.
"""

import contextlib
import functools
import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

import torch

Piece = TypeVar("Piece")


@contextlib.contextmanager
def one_thread() -> Iterator[int]:
    """Let each operation of torch be done by one thread.

    Yields:
        How many threads torch may use outside, and `for_each` inside.
    """
    num_threads = torch.get_num_threads()
    if num_threads == 1:
        yield 1
        return
    torch.set_num_threads(1)
    try:
        yield num_threads
    finally:
        torch.set_num_threads(num_threads)


def for_each(
    pieces: Sequence[Piece], worker: Callable[[], Callable[[Piece], None]], *, num_threads: int
) -> None:
    """Work on every piece, each in one thread, without gradients; to be called inside `one_thread`.

    Args:
        pieces: What to work on. Who is free takes the next one.
        worker: Makes what works on pieces in one thread, with buffers of its own.
        num_threads: Threads to work with, this one among them.
    """
    assert torch.get_num_threads() == 1, "for_each is for use inside one_thread"
    pending = iter(pieces)  # next() on it is atomic

    @torch.inference_mode()
    def work() -> None:
        handle = worker()
        for piece in pending:
            handle(piece)

    num_helpers = min(num_threads, len(pieces)) - 1
    helpers = [_helpers(num_threads - 1).submit(_help, work) for _ in range(num_helpers)]
    try:
        work()
    finally:
        for helper in helpers:
            helper.result()


def stay_one_thread() -> None:
    """Let each operation that the calling thread does from now on be done by it alone.

    The number that torch gives to threads that are still to come is set with it: who calls this in a thread of its own
    sets that back, as `one_thread` does at its end.
    """
    # Asked first, as the first operation of a thread takes over what was set last in any thread.
    if torch.get_num_threads() != 1:
        torch.set_num_threads(1)


def _help(work: Callable[[], None]) -> None:
    stay_one_thread()
    work()


@functools.cache
def _helpers(count: int) -> ThreadPoolExecutor:
    """Threads that wait for work."""
    return ThreadPoolExecutor(count, thread_name_prefix="models")


if hasattr(os, "register_at_fork"):  # a fork copies the executor, but none of its threads
    os.register_at_fork(after_in_child=_helpers.cache_clear)
