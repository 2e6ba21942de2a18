"""Videos of turns from one moment: the same state lived again, and what the policy saw and thought of it each time."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import UInt8

from mjdrive.bev import picture as bev_picture
from mjdrive.bev.projector import BevProjector
from mjdrive.datatypes import Episode, Observation, Town
from mjdrive.episodes.views import states
from mjdrive.files import write_atomically
from mjdrive.recording import mp4
from mjdrive.recording.pages import GAP, HEAD, LABEL, Page
from mjdrive.recording.panels import PANEL, landscape_panel, map_panel
from mjdrive.study.jobs.landscapes import probabilities
from mjdrive.vehicle.parameters import VehicleParameters
from models.interfaces import Learner

FRAMES_PER_SECOND = 10
"""One frame a decision: videos run as fast as the car [1/s]."""

LONGEST = 8.0
"""The turn is over by then [s]."""

POINTS = 33
"""Grid points of the landscapes along each action component [-]; they are drawn smoothly between them."""

MIDDLE_AHEAD = 20.0
"""The middle of the map lies so far ahead of where the car begins [m]: in the junction."""


class Drive(NamedTuple):
    """A drive to be shown.

    Attributes:
        title: What it did, as in "turns left".
        episode: The drive; those of one video begin at the same moment.
    """

    title: str
    episode: Episode


def write_turns(
    drives: Sequence[Drive], learner: Learner, town: Town, path: Path, *, title: str
) -> None:
    """Write a video of several drives from one moment, one below the other.

    Args:
        drives: At least one.
        learner: The policy that drove.
        town: Where.
        path: MP4 file to write.
        title: What the video shows.
    """
    frames = _frames(drives, learner, town, title)
    write_atomically(path, mp4.encode(frames, frames_per_second=FRAMES_PER_SECOND))


def _frames(
    drives: Sequence[Drive], learner: Learner, town: Town, title: str
) -> Iterator[UInt8[np.ndarray, "H W 3"]]:
    studio = _Studio(learner, town, BevProjector(town), VehicleParameters.default())
    height = HEAD + len(drives) * (PANEL + LABEL) + GAP
    page = Page(3 * PANEL + 4 * GAP, height + height % 2, title)
    for step in range(max(_num_steps(drive.episode) for drive in drives)):
        for row, drive in enumerate(drives):
            if step < _num_steps(drive.episode):  # who is through first waits for the other
                _put(page, row, studio.panels(drive.episode, step), drive, step)
        yield page.picture


def _num_steps(episode: Episode) -> int:
    return min(len(episode.time), round(LONGEST * FRAMES_PER_SECOND))


class _Studio(NamedTuple):
    """All that the panels of a frame are drawn with."""

    learner: Learner
    town: Town
    projector: BevProjector
    parameters: VehicleParameters

    def panels(self, episode: Episode, step: int) -> tuple[UInt8[np.ndarray, "P P 3"], ...]:
        """What the policy sees at a step, what it thinks of every action, and where the car is."""
        bev = self.projector.replay(episode, step)
        seen = Observation(bev=bev, state=states(episode)[step])
        config = self.projector.config
        scale = PANEL // config.size_px
        start = episode.vehicle[0]
        ahead = np.array([np.cos(start[2]), np.sin(start[2])])
        return (
            bev_picture.picture(bev, config, self.parameters, scale=scale),
            landscape_panel(
                probabilities(self.learner, seen, points=POINTS), episode.actions[step]
            ),
            map_panel(
                self.town,
                start[:2] + MIDDLE_AHEAD * ahead,
                episode.vehicle[: step + 1],
                self.parameters,
                clock=float(episode.time[step]) + episode.light_phase,
            ),
        )


def _put(page: Page, row: int, panels: Sequence[np.ndarray], drive: Drive, step: int) -> None:
    """Put the panels of a drive into their row, and write above them what they are."""
    speed = 3.6 * float(drive.episode.vehicle[step, 3])
    seconds = float(drive.episode.time[step] - drive.episode.time[0])
    labels = (
        f"what it sees: {drive.title}",
        "energy; ring: action chosen, left is left, up is throttle",
        f"{seconds:.1f} s, {speed:.0f} km/h",
    )
    page.put_row(HEAD + row * (PANEL + LABEL), panels, labels)
