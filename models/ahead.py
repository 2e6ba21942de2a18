"""The next minibatch is made ready while the network learns from this one."""

from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

import torch

from models.threads import stay_one_thread

Item = TypeVar("Item")


def one_ahead(items: Iterable[Item]) -> Iterator[Item]:
    """Make each item in a thread of its own while the one before is worked on.

    Args:
        items: Made one after the other, so that what is drawn in them is drawn in the same order.

    Yields:
        The items.
    """
    waiting = iter(items)
    num_threads = torch.get_num_threads()
    with ThreadPoolExecutor(1) as maker:
        # One thread inside it, too: a second crew would take the cores from the step that goes on.
        maker.submit(stay_one_thread).result()
        torch.set_num_threads(num_threads)  # for threads that are still to come
        coming = maker.submit(next, waiting, None)
        while (item := coming.result()) is not None:
            coming = maker.submit(next, waiting, None)
            yield item
