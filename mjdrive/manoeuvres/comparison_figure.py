"""The picture of `mjdrive car compare`."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mjdrive.manoeuvres.comparison import KINEMATIC, LINEAR, MULTI_BODY, Behaviour, Comparison
from mjdrive.manoeuvres.plant import UPDATE_INTERVAL
from mjdrive.picture_style import STYLE, save

LOOKS = {
    KINEMATIC: ("#8c959f", ":"),
    LINEAR: ("#57606a", "--"),
    MULTI_BODY: ("#bc4c00", "-"),
}
"""Colour and line of each model; the car itself is blue."""

CAR = ("#0969da", "-")
MOST_SHOWN = 11.0  # lateral acceleration [m/s2]
SPEED_KMH = 80


def draw(comparisons: Sequence[Comparison], path: Path) -> None:
    """Draw steering angles over lateral acceleration and step responses, a row a comparison.

    Args:
        comparisons: What was compared.
        path: PNG file to write.
    """
    with matplotlib.style.context(["default", STYLE]):
        figure = Figure(figsize=(6.8, 2.5 * len(comparisons)), layout="constrained")
        rows = figure.subplots(len(comparisons), 2, squeeze=False)
        for (left, right), comparison in zip(rows, comparisons, strict=True):
            for name, behaviour in comparison.behaviours.items():
                color, line = LOOKS.get(name, CAR)
                _draw_circle(left, behaviour, name, color, line)
                _draw_step(right, behaviour, color, line)
            left.set(
                title=f"{comparison.title}: steady circle",
                xlabel=f"lateral acceleration at {SPEED_KMH} km/h [m/s²]",
                ylabel="steering angle [deg]",
                xlim=(0.0, MOST_SHOWN),
                ylim=(0.0, None),
            )
            left.legend(frameon=False, fontsize=7.5)
            right.set(
                title=f"{comparison.title}: step steer",
                xlabel="time since half of the steering angle [s]",
                ylabel="yaw rate / steady one [-]",
                xlim=(-0.2, 1.5),
            )
        save(figure, path)


def _draw_circle(axes: Axes, behaviour: Behaviour, name: str, color: str, line: str) -> None:
    recording = behaviour.circles[SPEED_KMH].recording
    window = np.full(round(0.5 / UPDATE_INTERVAL), UPDATE_INTERVAL / 0.5)
    lateral = np.convolve(recording.lateral_acceleration, window, "valid")
    angle = np.degrees(np.convolve(recording.steering_angle, window, "valid"))
    shown = slice(0, int(np.argmax(lateral >= min(lateral.max(), MOST_SHOWN))) + 1)
    axes.plot(lateral[shown], angle[shown], line, color=color, label=name)


def _draw_step(axes: Axes, behaviour: Behaviour, color: str, line: str) -> None:
    step = behaviour.step
    time = step.recording.time - step.start_time
    axes.plot(time, step.recording.yaw_rate / step.steady_yaw_rate, line, color=color)
