"""The same manoeuvres at half and at a quarter of the timestep."""

from collections.abc import Callable, Mapping
from pathlib import Path

from mjdrive.manoeuvres import handling
from mjdrive.manoeuvres.bars import Bar
from mjdrive.manoeuvres.handling import Handling
from mjdrive.manoeuvres.rig import TIMESTEP

DIVISORS = (2, 4)
MOST_CHANGE = 5.0  # of any figure [%]


def changes(reference: Handling, finer: Handling) -> Mapping[str, float]:
    """Change of each figure, over its size.

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
        changed = changes(reference, finer)
        worst = max(changed, key=lambda name: abs(changed[name]))
        found.append(
            Bar(
                f"timestep {1000 * timestep:.2f} ms",
                "largest change of a figure",
                abs(changed[worst]),
                "%",
                most=MOST_CHANGE,
                reason=f"{worst}, of {len(changed)} figures",
            )
        )
    return tuple(found)
