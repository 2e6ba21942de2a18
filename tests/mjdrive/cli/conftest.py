"""A machine of one core."""

import os
from collections.abc import Iterator

import pytest


@pytest.fixture
def on_one_core() -> Iterator[None]:
    """Give this process one core, as `taskset` and schedulers of clusters do."""
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(before)})
    yield
    os.sched_setaffinity(0, before)
