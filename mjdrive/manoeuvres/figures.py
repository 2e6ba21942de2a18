"""Curves of the manoeuvres: PNG, the same bytes for the same car, drawn without a display."""

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mjdrive.manoeuvres import acceleration, standstill
from mjdrive.manoeuvres.handling import Handling
from mjdrive.manoeuvres.plant import UPDATE_INTERVAL
from mjdrive.manoeuvres.rig import GRAVITY
from mjdrive.picture_style import STYLE, save

COLORS = ("#0969da", "#bc4c00", "#1a7f37")
"""Of the curves of one diagram: blue, orange, green."""

REFERENCE_COLOR = "0.45"
"""Of models and closed forms, which are dashed."""


def draw(handling: Handling, folder: Path, names: Sequence[str] | None = None) -> tuple[Path, ...]:
    """Draw diagrams.

    Args:
        handling: The manoeuvres.
        folder: Where the PNG files go.
        names: Which of `DIAGRAMS`; all if None.

    Returns:
        The files.
    """
    paths = []
    for name in DIAGRAMS if names is None else names:
        fill, size = DIAGRAMS[name]
        with matplotlib.style.context(["default", STYLE]):
            figure = Figure(figsize=size, layout="constrained")
            fill(handling, figure)
            paths.append(folder / f"{name}.png")
            save(figure, paths[-1])
    return tuple(paths)


def _draw_acceleration(handling: Handling, figure: Figure) -> None:
    axes, recording = figure.add_subplot(), handling.acceleration
    seconds = acceleration.time_to_target(recording)
    axes.plot(recording.time, 3.6 * recording.speed, color=COLORS[0])
    axes.plot(seconds, 100.0, "o", color=COLORS[0])
    axes.annotate(
        f"100 km/h after {seconds:.1f} s",
        (seconds, 100.0),
        xytext=(-50, 0),
        textcoords="offset points",
        ha="right",
        va="center",
    )
    axes.set(title="Full throttle from rest", xlabel="time [s]", ylabel="speed [km/h]")
    _from_zero(axes)


def _draw_braking(handling: Handling, figure: Figure) -> None:
    axes = figure.add_subplot()
    for stop, color in zip(handling.stops, COLORS, strict=False):
        distance = stop.recording.distance
        label = f"from {stop.speed_kmh} km/h: {stop.distance:.1f} m"
        axes.plot(distance, 3.6 * stop.recording.speed, color=color, label=label)
        axes.axvline(stop.expected, color=color, linestyle="--", linewidth=0.9)
    axes.plot([], [], "--", color=REFERENCE_COLOR, label="end by v² / (2 μ g) + lag · v")
    axes.set(title="Full brake", xlabel="distance [m]", ylabel="speed [km/h]")
    axes.legend(frameon=False)
    _from_zero(axes)


def _draw_handling_diagram(handling: Handling, figure: Figure) -> None:
    axes = figure.add_subplot()
    for circle, color in zip(handling.circles, COLORS, strict=True):
        recording = circle.recording
        window = round(0.5 / UPDATE_INTERVAL)
        lateral = _smooth(recording.lateral_acceleration, window)
        angle = np.degrees(_smooth(recording.steering_angle, window))
        until = int(lateral.argmax()) + 1
        label = f"{circle.speed_kmh} km/h, limit {circle.limit / GRAVITY:.2f} g"
        axes.plot(lateral[:until], angle[:until], color=color, label=label)
        speed = circle.speed_kmh / 3.6
        straight = np.linspace(0.0, 0.8 * GRAVITY, 2)
        gain = speed * circle.single_track.yaw_rate_gain(speed)
        axes.plot(straight, np.degrees(straight / gain), "--", color=color, linewidth=0.9)
    axes.plot([], [], "--", color=REFERENCE_COLOR, label="linear single-track model")
    axes.set(
        title="Steady circles (ISO 4138)",
        xlabel="lateral acceleration [m/s²]",
        ylabel="steering angle [deg]",
    )
    axes.legend(frameon=False, loc="upper left")
    _from_zero(axes)


def _draw_step(handling: Handling, figure: Figure) -> None:
    step = handling.step
    recording, speed = step.recording, step.speed_kmh / 3.6
    time = recording.time - step.start_time
    model_lateral, model_yaw_rate = step.single_track.respond(
        speed, recording.time, recording.steering_angle
    )
    model_slip = np.arctan2(model_lateral, speed)
    acceleration_of_model = np.gradient(model_lateral, recording.time) + speed * model_yaw_rate
    rows = figure.subplots(4, 1, sharex=True)
    curves: tuple[tuple[str, np.ndarray, np.ndarray | None], ...] = (
        ("steering angle\n[deg]", np.degrees(recording.steering_angle), None),
        ("yaw rate\n[deg/s]", np.degrees(recording.yaw_rate), np.degrees(model_yaw_rate)),
        ("lateral acc.\n[m/s²]", recording.lateral_acceleration, acceleration_of_model),
        ("body slip\n[deg]", np.degrees(recording.body_slip), np.degrees(model_slip)),
    )
    for axes, (label, measured, expected) in zip(rows, curves, strict=True):
        axes.plot(time, measured, color=COLORS[0], label="car")
        if expected is not None:
            axes.plot(
                time, expected, "--", color=REFERENCE_COLOR, label="linear single-track model"
            )
        axes.set_ylabel(label)
        axes.axvline(0.0, color="0.85", linewidth=0.8, zorder=0)
    rows[0].set_title(f"Step steer at {step.speed_kmh:.0f} km/h (ISO 7401)")
    rows[1].legend(frameon=False, loc="lower right")
    rows[-1].set(xlabel="time since half of the steering angle [s]", xlim=(-0.2, 2.0))
    figure.align_ylabels(rows)


def _draw_turning_circle(handling: Handling, figure: Figure) -> None:
    axes, circle = figure.add_subplot(), handling.turning_circle
    x, y = circle.centre
    round_about = np.linspace(0.0, 2.0 * math.pi, 361)
    outer = 0.5 * circle.kerb_to_kerb
    paths = (
        (circle.radius, "-", COLORS[0], f"rear-axle centre, radius {circle.radius:.2f} m"),
        (outer, "-", COLORS[1], f"outer front wheel, diameter {circle.kerb_to_kerb:.1f} m"),
        (circle.expected_radius, "--", REFERENCE_COLOR, "wheelbase / tan(full lock)"),
    )
    for radius, line, color, label in paths:
        axes.plot(
            radius * np.cos(round_about),
            radius * np.sin(round_about),
            line,
            color=color,
            label=label,
        )
    recording = circle.recording
    axes.plot(recording.x - x, recording.y - y, color=COLORS[0], linewidth=2.0)
    _draw_car(axes, handling)
    axes.set(title="Full lock at 2 m/s", xlabel="x [m]", ylabel="y [m]", aspect="equal")
    figure.legend(loc="outside lower center", frameon=False)


def _draw_car(axes: Axes, handling: Handling) -> None:
    """Draw the footprint of the car at the bottom of its circle, where it drives along x."""
    circle, parameters = handling.turning_circle, handling.turning_circle.parameters
    rear, front = -parameters.rear_overhang, parameters.length - parameters.rear_overhang
    half = 0.5 * parameters.width
    corners = np.array([[rear, -half], [front, -half], [front, half], [rear, half]])
    corners = corners - [0.0, circle.radius]
    axes.fill(*corners.T, facecolor="#dcdfe3", edgecolor="0.3", zorder=0)


def _draw_standstill(handling: Handling, figure: Figure) -> None:
    axes = figure.add_subplot()
    for rest, color in zip(handling.standstills, COLORS, strict=True):
        recording = rest.recording
        moved = 1000.0 * np.hypot(recording.x - recording.x[0], recording.y - recording.y[0])
        most = standstill.MOST_CREEP_MM[rest.slope]
        label = f"{100 * rest.slope:.0f} % slope: {moved.max():.2f} mm, bar {most:.0f} mm"
        axes.plot(recording.time, moved, color=color, label=label)
    axes.set(title="At rest with the brake on", xlabel="time [s]", ylabel="creep [mm]")
    axes.legend(frameon=False)
    _from_zero(axes)


def _smooth(quantity: np.ndarray, window: int) -> np.ndarray:
    return np.convolve(quantity, np.full(window, 1.0 / window), "valid")


def _from_zero(axes: Axes) -> None:
    axes.set(xlim=(0.0, None), ylim=(0.0, None))
    axes.grid(color="0.92", linewidth=0.6)


DIAGRAMS: Mapping[str, tuple[Callable[[Handling, Figure], None], tuple[float, float]]] = {
    "acceleration": (_draw_acceleration, (5.2, 3.4)),
    "braking": (_draw_braking, (5.2, 3.4)),
    "handling": (_draw_handling_diagram, (5.6, 4.2)),
    "step_steer": (_draw_step, (5.6, 6.2)),
    "turning_circle": (_draw_turning_circle, (4.8, 6.0)),
    "standstill": (_draw_standstill, (5.2, 3.4)),
}
"""What draws each diagram, and its size [inch]."""
