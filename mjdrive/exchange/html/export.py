"""`mjdrive export --to html`."""

from collections.abc import Callable
from pathlib import Path

from mjdrive.exchange.html.page import EpisodePage
from mjdrive.exchange.sources import Recording


def write(recording: Recording, path: Path, *, on_step: Callable[[int], None]) -> None:
    """Write one drive as a page.

    Raises:
        DataError: If town or car are not those of the episode.
    """
    EpisodePage(recording.episode, car=recording.car, on_step=on_step).save(path)
