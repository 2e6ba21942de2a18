"""Find the policies that come with mjdrive: folders in `models/zoo`, in the checkout and in the wheel alike.

config.json         settings of the learner
state.json          method, seed, epochs
source.json         what it was trained on
model.safetensors   weights, in float16 where that is lossless enough
card.json           how it was made, how it drives, and a short drive to check it by
README.md           the card for people

All but the last two are what a training run consists of that only drives, and are read as one.
"""

from pathlib import Path

import models
from mjdrive.errors import UnknownNameError

PREFIX = "zoo:"
"""Names of policies that begin so are names of entries."""

DEFAULT = "da-ibc"
"""Who drives where nobody was trained."""

CARD = "card.json"
PAGE = "README.md"

FOLDER = Path(models.__file__).parent / "zoo"


def names(folder: Path = FOLDER) -> tuple[str, ...]:
    """List the entries, in alphabetical order."""
    return tuple(sorted(card.parent.name for card in folder.glob(f"[!.]*/{CARD}")))


def full_names(folder: Path = FOLDER) -> tuple[str, ...]:
    """List the entries as users name them."""
    return tuple(PREFIX + name for name in names(folder))


def find(name: str, folder: Path = FOLDER) -> Path:
    """Find an entry.

    Args:
        name: As users say it, as zoo:da-ibc.
        folder: Where the entries are.

    Returns:
        Its folder, which can be loaded as the folder of a run.

    Raises:
        UnknownNameError: If there is no such entry.
    """
    if name not in full_names(folder):
        hint = f"`mjdrive drive --policy {PREFIX}` says what they can do."
        raise UnknownNameError("shipped policy", name, full_names(folder), hint=hint)
    return folder / name.removeprefix(PREFIX)
