"""The same manoeuvres at half and at a quarter of the timestep."""

import math
from collections.abc import Callable, Mapping
from pathlib import Path

from mjdrive.manoeuvres import handling
from mjdrive.manoeuvres.bars import Bar
from mjdrive.manoeuvres.handling import Handling
from mjdrive.manoeuvres.rig import TIMESTEP

DIVISORS = (2, 4)
MOST_CHANGE = 5.0  # of any figure [%]


def changes(reference: Handling, finer: Handling) -> Mapping[str, float]:
    """Change of each figure, over its size (`Handling.figures`).

    Args:
        reference: At the timestep that is used.
        finer: At a smaller one.

    Returns:
        Changes by the name of the figure [%].
    """
    coarse, fine = reference.figures(), finer.figures()
    return {name: 100.0 * (fine[name][0] - value) / size for name, (value, size) in coarse.items()}


def bars(
    reference: Handling,
    car: Path | None = None,
    on_manoeuvre: Callable[[], None] = lambda: None,
) -> tuple[Bar, ...]:
    """Hold the figure that changes most against 5 %.

    Args:
        reference: The manoeuvres at the timestep that is used.
        car: MJCF; the default car if None.
        on_manoeuvre: Called after each manoeuvre.
    """
    found = []
    for divisor in DIVISORS:
        timestep = TIMESTEP / divisor
        finer = handling.measure(car, timestep=timestep, on_manoeuvre=on_manoeuvre)
        found.append(worst_change(changes(reference, finer), timestep))
    return tuple(found)


def worst_change(changed: Mapping[str, float], timestep: float) -> Bar:
    """Hold the largest change against 5 %; one that is no number is larger than any.

    Args:
        changed: Changes by the name of the figure [%].
        timestep: The smaller one [s].
    """
    worst = max(changed, key=lambda name: (math.isnan(changed[name]), abs(changed[name])))
    return Bar(
        f"timestep {1000 * timestep:.2f} ms",
        "largest change of a figure",
        abs(changed[worst]),
        "%",
        most=MOST_CHANGE,
        reason=f"{worst}, of {len(changed)} figures",
    )
