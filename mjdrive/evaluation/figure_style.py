"""What all pictures of drives share: symbols and titles."""

from mjdrive.datatypes import Episode, InfractionKind
from mjdrive.evaluation import metrics

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
