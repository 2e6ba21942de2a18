"""The videos of a study: for each agent whose turns were kept, those that it took from one moment."""

from collections.abc import Callable, Sequence
from pathlib import Path

from mjdrive.datatypes import Town
from mjdrive.episodes import store
from mjdrive.files import write_atomically
from mjdrive.study.records.results import Turn
from mjdrive.study.videos.turn_video import Drive, write_turns
from models.interfaces import Learner

VIDEOS = "videos"
"""Folder of the videos."""

WORDS = {"left": "turns left", "straight": "goes straight on", "right": "turns right"}
"""What a drive does, by its move."""


def write_videos(
    turns: Sequence[Turn],
    learner_of: Callable[[str, int], Learner],
    labels: dict[str, str],
    town: Town,
    folder: Path,
    *,
    weights_of: Callable[[str, int], str],
    on_video: Callable[[int], None] = lambda done: None,
) -> None:
    """Write the videos that are missing, or show other turns or weights than those that are there now.

    Args:
        turns: Drives that were kept, of any agents.
        learner_of: Loads the network of an agent by arm and training seed.
        labels: What each arm is called, by name.
        town: Where they were driven.
        folder: Of the study; the videos go into a folder in it.
        weights_of: Tells the digest of its weights, likewise.
        on_video: Told the number of videos that are there.

    Raises:
        DataError: If the file of a drive is missing or damaged.
    """
    agents = list(dict.fromkeys((it.arm, it.seed) for it in turns))
    for done, (arm, seed) in enumerate(agents, start=1):
        path = folder / video_file(arm, seed)
        made_from = path.with_suffix(".sha256")
        shown = [it for it in turns if (it.arm, it.seed) == (arm, seed)]
        title = f"{labels[arm]}, seed {seed}: from one moment in {town.name}"
        digest = _digest(shown, folder, title, weights_of(arm, seed))
        if not (path.is_file() and made_from.is_file() and made_from.read_text() == digest):
            drives = [Drive(WORDS[it.move], store.read(folder / it.file)) for it in shown]
            write_turns(drives, learner_of(arm, seed).eval(), town, path, title=title)
            write_atomically(
                made_from, digest.encode()
            )  # last, so that it never speaks of an older video
        on_video(done)


def _digest(turns: Sequence[Turn], folder: Path, title: str, weights: str) -> str:
    """SHA-256 of all that a video of some turns shows, hexadecimal."""
    files = [folder / it.file for it in turns]
    drives = [store.digest(it.read_bytes()) if it.is_file() else "missing" for it in files]
    moves = [it.move for it in turns]
    return store.digest("\n".join((title, weights, *moves, *drives)).encode())


def video_file(arm: str, seed: int) -> str:
    """Place of the video of an agent in the folder of a study."""
    return f"{VIDEOS}/{arm}-{seed}.mp4"
