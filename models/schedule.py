"""Step size as a pure function of the step, so that a resumed run needs no scheduler state."""

import math

from models.config import OptimiserConfig

WARM_UP_SHARE = 0.3
START_DIVISOR = 25.0
END_DIVISOR = 25e4


def learning_rate(step: int, num_steps: int, config: OptimiserConfig) -> float:
    """Step size of one step of a run.

    Args:
        step: Steps done before it.
        num_steps: Steps of the whole run.
        config: Highest step size and kind of schedule.

    Returns:
        The step size [-].

    Reference:
        Smith and Topin, Super-Convergence, 2018: one cycle, here of two half cosines.
    """
    highest = config.learning_rate
    if config.schedule == "constant":
        return highest
    top = max(WARM_UP_SHARE * num_steps - 1, 1.0)
    if step <= top:
        return _cosine(highest / START_DIVISOR, highest, step / top)
    share = (step - top) / max(num_steps - 1 - top, 1.0)
    return _cosine(highest, highest / END_DIVISOR, min(share, 1.0))


def _cosine(start: float, end: float, share: float) -> float:
    return end + (start - end) * 0.5 * (1 + math.cos(math.pi * share))
