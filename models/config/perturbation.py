"""From where demonstrations are seen."""

import dataclasses

from models.config.checks import require, require_not_negative, require_share


@dataclasses.dataclass(frozen=True, slots=True)
class PerturbationConfig:
    """Poses beside those that were driven, from which some pairs are seen; their steering is changed to lead back.

    Whoever makes pairs of demonstrations moves the car and draws what it would see (`mjdrive.learning.perturbation`).

    Attributes:
        share: Of pairs that are seen from beside; 0 for none [-].
        offset: Largest shift to either side [m].
        heading: Largest turn to either side [rad].

    Reference:
        Bojarski et al., End to End Learning for Self-Driving Cars, 2016 (shifted and turned views whose label leads
        back); Bansal, Krizhevsky, Ogale, ChauffeurNet, RSS 2019 (perturbed poses rendered from states).
    """

    share: float = 0.0
    offset: float = 0.8
    heading: float = 0.2

    def __post_init__(self) -> None:
        require_share(self, "share")
        require_not_negative(self, "offset")
        require(self, "heading", 0 <= self.heading < 1.5, "an angle in [0, 1.5) rad")
