"""What all diagrams share: style, and files that are the same for the same content."""

import io
from pathlib import Path

from matplotlib.figure import Figure

from mjdrive.files import write_atomically

STYLE = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "figure.dpi": 150.0,
    "savefig.dpi": 150.0,
}
"""On top of matplotlib's defaults, so that a user's own style does not change the bytes."""


def save(figure: Figure, path: Path) -> None:
    """Write a figure without the version of the software that drew it."""
    picture = io.BytesIO()
    figure.savefig(picture, format="png", metadata={"Software": None})
    write_atomically(path, picture.getvalue())
