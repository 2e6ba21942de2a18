"""Expressions of casadi that read and write memory of MuJoCo: some ten times as fast as the same lines in Python, and no compiler is needed."""

from collections.abc import Callable, Sequence
from typing import Any, cast

import casadi as ca
import numpy as np
from jaxtyping import Float

Binding = tuple[ca.SX, Float[np.ndarray, "..."]]
"""Symbols or expressions, and the memory where their values are."""


def bind(inputs: Sequence[Binding], outputs: Sequence[Binding]) -> Callable[[], None]:
    """Tie a function to memory.

    Args:
        inputs: Symbols, and where their values are read.
        outputs: Expressions of these symbols, and where their values are written.

    Returns:
        Computes the outputs from what the inputs are when it is called; it keeps the memory alive.
    """
    function = ca.Function(
        "bound", [symbol for symbol, _ in inputs], [ca.densify(it) for it, _ in outputs]
    )
    buffer: Any
    buffer, evaluate = function.buffer()  # its types say less than it takes
    for number, (symbol, memory) in enumerate(inputs):
        buffer.set_arg(number, _numbers(memory, symbol))
    for number, (expression, memory) in enumerate(outputs):
        buffer.set_res(number, _numbers(memory, expression))
    # casadi notes addresses alone.
    owners = (buffer, *(memory for _, memory in (*inputs, *outputs)))

    def call(_owners: tuple[object, ...] = owners) -> None:
        evaluate()

    return call


def _numbers(memory: Float[np.ndarray, "..."], values: ca.SX) -> "memoryview[float]":
    assert memory.dtype == np.float64, f"{memory.dtype}, float64 needed"
    assert memory.flags.c_contiguous, "memory with gaps"
    assert memory.size == values.numel(), f"{memory.size} numbers for {values.numel()} values"
    return cast("memoryview[float]", memory.reshape(-1).data)
