import contextlib
from collections.abc import Iterator

import pytest
import torch
from torch.nn import functional as F  # noqa: N812

from models import presets
from models.learners import build_learner
from models.steady_linear import SteadyLinear

# Powers of two cut these matrices into equal parts, which would hide what others do.
THREAD_COUNTS = (1, 2, 3, 5, 7)


@contextlib.contextmanager
def threads(count: int) -> Iterator[None]:
    before = torch.get_num_threads()
    torch.set_num_threads(count)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def with_each(act):
    """What some work gives with each number of threads."""
    results = []
    for count in THREAD_COUNTS:
        with threads(count), torch.no_grad():
            results.append(act())
    return results


def test_a_single_row_does_not_depend_on_the_number_of_threads(generator):
    layer = SteadyLinear(1280, 512)
    row = torch.randn(1, 1280, generator=generator)
    first, *others = with_each(lambda: layer(row))
    assert all(torch.equal(first, other) for other in others)


@pytest.mark.parametrize("method", ["bc-beta", "ibc", "da-ibc"])
def test_decisions_do_not_depend_on_the_number_of_threads(method, batch, generator):
    learner = build_learner(presets.paper(method), seed=0).eval()
    learner.prepare(batch.actions, torch.ones(len(batch.actions)))

    def act():
        generator.manual_seed(1)
        return learner.act(batch.bev[:1], batch.state[:1], generator=generator)

    first, *others = with_each(act)
    assert all(torch.equal(first, other) for other in others)


def test_it_is_the_product_with_a_matrix_whatever_the_rows_and_gradients(generator):
    layer = SteadyLinear(20, 30)
    for num_rows in (1, 4):
        rows = torch.randn(num_rows, 20, generator=generator)
        expected = F.linear(rows, layer.weight, layer.bias)
        torch.testing.assert_close(layer(rows), expected)
        assert layer(rows).requires_grad
        with torch.no_grad():
            torch.testing.assert_close(layer(rows), expected)


def test_the_number_of_threads_is_as_before_even_after_an_error(monkeypatch):
    layer, row = SteadyLinear(20, 30), torch.ones(1, 20)
    with threads(3), torch.no_grad():
        layer(row)
        assert torch.get_num_threads() == 3
        monkeypatch.setattr(F, "linear", broken)
        with pytest.raises(RuntimeError, match="broken in 1 thread"):
            layer(row)
        assert torch.get_num_threads() == 3


def broken(*_):
    raise RuntimeError(f"broken in {torch.get_num_threads()} thread")
