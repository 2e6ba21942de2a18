"""Settings of tuning an expert to a car."""

from dataclasses import dataclass

from mjdrive.config.json_files import require
from mjdrive.config.ranges import NOT_NEGATIVE, POSITIVE, SOME_SHARE, require_ranges


@dataclass(frozen=True, slots=True)
class TuneConfig:
    """What is tried, and what good driving is.

    The cost of a trial is the sum of its marks, each over its scale: a mark of the size of its scale costs 1.

    Attributes:
        trials: Settings that are tried, the present ones included [-].
        spread: Standard deviation of the first trials as a share of each setting's range [-].
        bends: Ways through junctions that are driven, unlike each other; all that are unlike if there are fewer [-].
        offset_scale: Root mean square distance from the route that costs 1 [m].
        whiteness_scale: Whiteness of the steering command that costs 1 [1/s].
        jerk_scale: Root mean square jerk that costs 1 [m/s3].
        slowness_scale: Time beyond what the speed limits allow, as a share of it, that costs 1 [-].
        mishap_cost: Cost of each infraction and of each exercise that is not finished [-].
    """

    trials: int = 80
    spread: float = 0.2
    bends: int = 8
    offset_scale: float = 0.10
    whiteness_scale: float = 0.30
    jerk_scale: float = 1.5
    slowness_scale: float = 0.25
    mishap_cost: float = 20.0

    def __post_init__(self) -> None:
        require(self.trials >= 2, f"trials is {self.trials}; expected 2 or more.")
        require(self.bends >= 1, f"bends is {self.bends}; expected 1 or more.")
        scales = ("offset_scale", "whiteness_scale", "jerk_scale", "slowness_scale")
        others = {"spread": SOME_SHARE, "mishap_cost": NOT_NEGATIVE}
        require_ranges(self, {**dict.fromkeys(scales, POSITIVE), **others})
