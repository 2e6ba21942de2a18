"""How the pictures of a study tell its arms apart: one colour a method, one line style a way to act."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from mjdrive.config import StudyConfig

COLOURS = {
    "bc-beta": "#d1570a",
    "bc-mixture": "#c69214",
    "bc-grid": "#7a3b1d",
    "ibc": "#1a7f37",
    "da-ibc": "#0969da",
    "ibc-langevin": "#14858a",
    "diffusion": "#c2317f",
    "flow": "#7a4ddb",
}
"""Of each method."""

LINE_STYLES: tuple[Any, ...] = ("-", "--", ":", "-.", (0, (1, 3)))
"""Of the first way in which a method acts, the second and so on; from the fifth on all look alike."""

INK, PALE, GRID = "#1f2328", "#8c959f", "#d8dee4"
"""Of references, of what is beside the point, and of lines that only help the eye."""

REFERENCES = {
    "expert": ("expert, random walk", INK, (0, (5, 2))),
    "right-walker": ("always rightmost", PALE, (0, (2, 2))),
}
"""Label, colour and line style of who drives beside the agents."""


@dataclass(frozen=True, slots=True)
class Look:
    """How an arm appears.

    Attributes:
        label: What legends call it.
        colour: Of its lines and bars.
        line_style: As matplotlib has it.
    """

    label: str
    colour: str
    line_style: Any = "-"


def looks(config: StudyConfig) -> Mapping[str, Look]:
    """Give every arm and reference of a study its look, in the order of the study.

    Args:
        config: Its settings.

    Returns:
        Looks by the names of arms and references.
    """
    methods = {variant.name: variant.method for variant in config.variants}
    ways: Counter[str] = Counter()
    found = {}
    for arm in config.arms:
        method = methods[arm.variant]
        style = LINE_STYLES[min(ways[method], len(LINE_STYLES) - 1)]
        ways[method] += 1
        found[arm.name] = Look(arm.label, COLOURS[method], style)
    return found | {name: Look(*REFERENCES[name]) for name in config.references}


def main_arms(config: StudyConfig) -> tuple[str, ...]:
    """The first arm of each variant of the study itself, ablations left out."""
    first: dict[str, str] = {}
    changed = {variant.name for variant in config.variants if variant.change}
    for arm in config.arms:
        if arm.variant not in changed and not arm.change:
            first.setdefault(arm.variant, arm.name)
    return tuple(first.values())


def own_arms(config: StudyConfig) -> tuple[str, ...]:
    """Every arm of the study itself, ablations left out."""
    changed = {variant.name for variant in config.variants if variant.change}
    return tuple(it.name for it in config.arms if not it.change and it.variant not in changed)
