import threading

import pytest
import torch

from models.ahead import one_ahead


def test_items_come_in_order_and_from_another_thread():
    threads = set()

    def numbers():
        for number in range(5):
            threads.add(threading.get_ident())
            yield number

    assert list(one_ahead(numbers())) == list(range(5))
    assert threads.isdisjoint({threading.get_ident()})


def test_one_item_is_made_while_the_one_before_is_worked_on():
    made = threading.Event()

    def numbers():
        yield 0
        made.set()
        yield 1

    items = one_ahead(numbers())
    assert next(items) == 0
    assert made.wait(timeout=10)
    items.close()


def test_what_goes_wrong_in_making_is_told_where_it_is_used():
    def broken():
        yield 1
        raise ValueError("spilt")

    items = one_ahead(broken())
    assert next(items) == 1
    with pytest.raises(ValueError, match="spilt"):
        next(items)


def test_the_threads_of_the_step_are_left_alone():
    before = torch.get_num_threads()
    assert list(one_ahead([1, 2])) == [1, 2]
    assert torch.get_num_threads() == before


def test_threads_that_begin_later_compute_with_as_many_threads_as_before():
    before, seen = torch.get_num_threads(), []
    torch.set_num_threads(3)
    try:
        assert list(one_ahead([1, 2])) == [1, 2]
        later = threading.Thread(target=lambda: seen.append(torch.get_num_threads()))
        later.start()
        later.join()
    finally:
        torch.set_num_threads(before)
    assert seen == [3]
