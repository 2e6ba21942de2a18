"""What `check` can find in a town."""

from dataclasses import dataclass
from enum import IntEnum, StrEnum


class Severity(IntEnum):
    """How bad a finding is."""

    NOTE = 0
    WARNING = 1
    ERROR = 2


class FindingKind(StrEnum):
    """What can be wrong with a town."""

    GAP = "gap"
    NO_LENGTH = "lane without length"
    DEAD_END = "dead end"
    ON_LANE = "thing on a lane"
    IDLE_LIGHT = "light that controls nothing"
    NEVER_GREEN = "light that never turns green"
    CROSSED_STOP_LINES = "stop lines that cross"
    SHORT_DRIVES = "short drives only"
    KINK = "kink"
    UNREACHED = "lane that nothing leads to"
    NARROW = "narrow lane"
    ISLAND = "island"
    TIGHT_TURN = "tight turn"


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that is wrong, or worth to know.

    Attributes:
        kind: What it is.
        severity: How bad it is.
        where: Name of the lane, light, signal, object or town.
        text: One sentence with the figures.
    """

    kind: FindingKind
    severity: Severity
    where: str
    text: str

    @property
    def breaks_a_drive(self) -> bool:
        """Whether a car that comes there cannot go on, or is judged by what is not there."""
        return self.severity is Severity.ERROR
