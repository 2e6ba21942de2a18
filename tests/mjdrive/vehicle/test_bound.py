import casadi as ca
import numpy as np
import pytest

from mjdrive.vehicle.bound import bind


def test_outputs_follow_their_inputs_at_each_call():
    x, y = ca.SX.sym("x", 2), ca.SX.sym("y")
    memory, factor, scaled, total = np.array([1.0, 2.0]), np.array([3.0]), np.zeros(2), np.zeros(1)
    compute = bind([(x, memory), (y, factor)], [(y * x, scaled), (ca.sum1(x), total)])
    assert scaled.tolist() == [0.0, 0.0]
    compute()
    assert (scaled.tolist(), total.tolist()) == ([3.0, 6.0], [3.0])
    memory[1] = 5.0
    compute()
    assert (scaled.tolist(), total.tolist()) == ([3.0, 15.0], [6.0])


def test_memory_lives_as_long_as_what_reads_it():
    x = ca.SX.sym("x", 1000)
    total = np.zeros(1)
    compute = bind([(x, np.arange(1000.0))], [(ca.sum1(x), total)])
    others = [np.full(1000, -1.0) for _ in range(50)]  # would take its place
    compute()
    assert total.item() == 499_500
    assert len(others) == 50


def test_part_of_a_larger_memory_is_written_alone():
    x = ca.SX.sym("x")
    table = np.zeros((3, 2))
    bind([(x, np.array([4.0]))], [(ca.vertcat(x, -x), table[1])])()
    assert table.tolist() == [[0.0, 0.0], [4.0, -4.0], [0.0, 0.0]]


@pytest.mark.parametrize("memory", [np.zeros(2, np.float32), np.zeros((2, 2))[:, 0], np.zeros(3)])
def test_memory_of_another_kind_is_refused(memory):
    x = ca.SX.sym("x", 2)
    with pytest.raises(AssertionError):
        bind([(x, memory)], [(x, np.zeros(2))])
