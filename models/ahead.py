"""The next minibatch is made ready while the network learns from this one."""

from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

import torch

Item = TypeVar("Item")


def one_ahead(items: Iterable[Item]) -> Iterator[Item]:
    """Make each item in a thread of its own while the one before is worked on.

    Args:
        items: Made one after the other, so that what is drawn in them is drawn in the same order.

    Yields:
        The items.
    """
    waiting = iter(items)
    # One thread inside it, too: a second crew would take the cores from the step that goes on.
    with ThreadPoolExecutor(1, initializer=torch.set_num_threads, initargs=(1,)) as maker:
        coming = maker.submit(next, waiting, None)
        while (item := coming.result()) is not None:
            coming = maker.submit(next, waiting, None)
            yield item
