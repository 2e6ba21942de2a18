"""Which numbers a setting may be: ranges, and the refusal of what lies outside."""

import dataclasses
import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from mjdrive.config.json_files import require


class Range(NamedTuple):
    """Numbers between two limits, all of them finite.

    Attributes:
        words: What they are called, in the unit of the setting.
        least: Smallest of them, in the unit of the setting.
        most: Largest of them, in the unit of the setting.
        includes_least: Whether the smallest is one of them.
    """

    words: str
    least: float
    most: float = math.inf
    includes_least: bool = True

    def holds(self, value: int | float) -> bool:
        """Whether a number is one of them; what is no number never is."""
        is_over = value >= self.least if self.includes_least else value > self.least
        return math.isfinite(value) and is_over and value <= self.most


FINITE = Range("a finite number", -math.inf)
POSITIVE = Range("a positive number, not infinite", 0.0, includes_least=False)
NOT_NEGATIVE = Range("0 or more, not infinite", 0.0)
SHARE = Range("a share in [0, 1]", 0.0, 1.0)
SOME_SHARE = Range("a share in (0, 1]", 0.0, 1.0, includes_least=False)
COUNT = Range("at least 1", 1.0)


def require_ranges(config: Any, ranges: Mapping[str, Range]) -> None:
    """Refuse settings with a number that has no meaning.

    Args:
        config: Settings, a dataclass; a setting may be several numbers.
        ranges: What each setting may be, by its name.

    Raises:
        ConfigError: If a number lies outside; it names the setting, the range and the default.
    """
    defaults = {field.name: field.default for field in dataclasses.fields(config)}
    for name, allowed in ranges.items():
        value = getattr(config, name)
        numbers = value if isinstance(value, tuple) else (value,)
        require(
            all(allowed.holds(number) for number in numbers),
            f"{name} is {value}; expected {allowed.words}, such as the default {defaults[name]}.",
        )
