"""How long a choice between ways lasts."""

import dataclasses

from models.config.checks import require, require_not_negative


@dataclasses.dataclass(frozen=True, slots=True)
class CommitmentConfig:
    """How long a sampled choice between left, straight on and right lasts; all else is drawn anew each time.

    What is chosen has the same distribution at each moment whatever the settings are. But who tosses a coin ten times a second at a
    fork drives into the middle of it.

    Attributes:
        hold: Decisions for which the chance of the choice lasts on average; 0 for one, so that nothing lasts [-].
        split: Modes whose densest action steers by more are to the left, or to the right [-].
    """

    hold: int = 0
    split: float = 0.15

    def __post_init__(self) -> None:
        require_not_negative(self, "hold")
        require(self, "split", 0 < self.split < 1, "a number between 0 and 1")
