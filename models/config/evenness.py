"""How evenly training draws what was seen."""

import dataclasses

from models.config.checks import require_not_negative, require_positive


@dataclasses.dataclass(frozen=True, slots=True)
class EvennessConfig:
    """How evenly training draws the speeds of the demonstrations.

    Of a drive with traffic lights, more than a third is waiting and most of the rest is cruising; braking, turning and starting are rare.
    Unlike 1 / KDE of the action, a weight that hangs on the observation alone leaves p(action given observation) as it is.

    Attributes:
        speed_exponent: Power of 1 / (density of the speed) that pairs are drawn by; 0 draws all alike, 1 all speeds alike [-].
        speed_bandwidth: Standard deviation of the Gaussian kernel of that density [m/s].
    """

    speed_exponent: float = 0.0
    speed_bandwidth: float = 0.4

    def __post_init__(self) -> None:
        require_not_negative(self, "speed_exponent")
        require_positive(self, "speed_bandwidth")
