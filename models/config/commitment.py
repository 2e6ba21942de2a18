"""How long the chance that decides about steering lasts."""

import dataclasses

from models.config.checks import require_not_negative


@dataclasses.dataclass(frozen=True, slots=True)
class CommitmentConfig:
    """How long sampled steering keeps to its place in the distribution; acceleration is drawn anew each time.

    What is chosen has the same distribution at each moment whatever the setting is. But who tosses a coin ten times a second at a
    fork drives into the middle of it, or has passed it before enough coins fell alike.

    Attributes:
        hold: Decisions after which the correlation of the chance has fallen to 1/e; 0 for none, so that nothing lasts [-].
    """

    hold: int = 0

    def __post_init__(self) -> None:
        require_not_negative(self, "hold")
