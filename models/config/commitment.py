"""How long the chance that decides about steering lasts."""

import dataclasses

from models.config.checks import require, require_not_negative


@dataclasses.dataclass(frozen=True, slots=True)
class CommitmentConfig:
    """How long sampled steering keeps to its place in the distribution; acceleration is drawn anew each time.

    What is chosen has the same distribution at each moment whatever `hold` is, but for turns that are gone on with. Who tosses a
    coin ten times a second at a fork drives into the middle of it, or has passed it before enough coins fell alike.

    Attributes:
        hold: Decisions after which the correlation of the chance has fallen to 1/e; 0 for none, so that nothing lasts [-].
        split: Modes whose densest action steers by more are turns to the left, or to the right [-].
        release: A turn that has been begun is gone on with as long as its side has this share of the distribution; with 1
            none is [-].
    """

    hold: int = 0
    split: float = 0.15
    release: float = 0.001

    def __post_init__(self) -> None:
        require_not_negative(self, "hold")
        require(self, "split", 0 < self.split < 1, "a number between 0 and 1")
        require(self, "release", 0 < self.release <= 1, "a number above 0, at most 1")
