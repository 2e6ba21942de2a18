import pytest

from mjdrive.datatypes import Episode
from mjdrive.recording.playback import Playback


@pytest.fixture(scope="session")
def playback(short_drive: Episode) -> Playback:
    """One world for all; whoever uses it shows a step."""
    return Playback(short_drive)
