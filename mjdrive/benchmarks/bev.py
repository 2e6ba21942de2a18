"""The bird's-eye view: time a frame, and beside the plain way to draw it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import cv2
import numpy as np

from mjdrive.benchmarks.comparison import Comparison, Figure, Plan, Row
from mjdrive.benchmarks.naive_bev import PlainProjector
from mjdrive.benchmarks.timing import THREAD, paired
from mjdrive.bev.projector import BevProjector
from mjdrive.datatypes import Town
from mjdrive.geometry import headings
from mjdrive.town import library, routing

TOWN = "town02"
NUM_FRAMES = 400
MOST_MS = 0.2  # a frame on one core [ms]
LEAST_RATIO = 2.0
SEED = 0

Pose = tuple[float, float, float]


def measure(plan: Plan) -> tuple[Row, ...]:
    """Draw the same poses both ways in turns.

    Args:
        plan: How much to measure.
    """
    town = library.load(TOWN)
    poses = drive_poses(town, NUM_FRAMES, np.random.default_rng(SEED))
    ours, plain = BevProjector(town), PlainProjector(town)
    with on_one_thread():
        pair = paired(
            lambda: _draw(ours.project, poses),
            lambda: _draw(plain.project, poses),
            rounds=plan.rounds(15),
            clock=THREAD,
        )
    return (
        Figure(
            name="bird's-eye view",
            work="a frame of 192 x 192 x 5 on one core",
            rounds=tuple(1e3 * seconds / len(poses) for seconds in pair.ours),
            unit="ms",
            most=MOST_MS,
            note="Processor time.",
        ),
        Comparison(
            name="bird's-eye view, plain",
            work="a frame of 192 x 192 x 5 on one core",
            ours="five layers out of one turned cut",
            theirs="one warp a layer, each light asked on its own",
            our_rounds=pair.ours,
            their_rounds=pair.theirs,
            bar=LEAST_RATIO,
            pieces=len(poses),
            piece="frame",
            note="Processor time.",
        ),
    )


def drive_poses(town: Town, count: int, rng: np.random.Generator) -> list[Pose]:
    """Choose poses as drives have them [m, m, rad]: 50 along each of many lanes."""
    poses: list[Pose] = []
    while len(poses) < count:
        name, _ = routing.random_start(town, rng)
        line = town.lanes[name].centerline
        steps = np.linspace(0.0, 1.0, 50)
        x, y = (np.interp(steps, np.linspace(0, 1, len(line)), line[:, axis]) for axis in (0, 1))
        yaw = headings(np.column_stack([x, y]))
        poses += zip(x.tolist(), y.tolist(), yaw.tolist(), strict=True)
    return poses[:count]


@contextmanager
def on_one_thread() -> Iterator[None]:
    """Let OpenCV use one thread, and afterwards as many as before."""
    before = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        yield
    finally:
        cv2.setNumThreads(before)


def _draw(project: Callable[..., np.ndarray], poses: list[Pose]) -> None:
    for number, (x, y, yaw) in enumerate(poses):
        project(x=x, y=y, yaw=yaw, time=0.1 * number, light_phase=0.0)
