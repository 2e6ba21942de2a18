"""What all pictures of drives share: style, symbols, titles, and files that are the same for the same drive."""

import io
from pathlib import Path

from matplotlib.figure import Figure

from mjdrive.datatypes import Episode, InfractionKind
from mjdrive.evaluation import metrics
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

SYMBOLS = {
    InfractionKind.RED_LIGHT: ("red light run", "X", "#d1242f"),
    InfractionKind.COLLISION: ("collision", "*", "#8250df"),
    InfractionKind.OFF_ROAD: ("left the road", "s", "#bc4c00"),
    InfractionKind.KERB: ("kerb struck", "^", "#0969da"),
    InfractionKind.WRONG_WAY: ("wrong way", "v", "#bf3989"),
    InfractionKind.STUCK: ("stuck", "P", "#1f2328"),
}
"""Legend text, marker and colour of each kind of infraction."""


def title(episode: Episode) -> str:
    """Who drove where, and how far, in one line."""
    distance = metrics.distance_on_lanes(episode)
    duration = metrics.control_interval(episode) * len(episode.time)
    return (
        f"{episode.policy} in {episode.town}, seed {episode.seed}: "
        f"{distance:,.0f} m in {duration:,.0f} s, "
        f"{len(episode.infractions) or 'no'} infraction{'' if len(episode.infractions) == 1 else 's'}"
    )


def save(figure: Figure, path: Path) -> None:
    """Write a figure without the version of the software that drew it."""
    picture = io.BytesIO()
    figure.savefig(picture, format="png", metadata={"Software": None})
    write_atomically(path, picture.getvalue())
