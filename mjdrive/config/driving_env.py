"""Settings of the environments for reinforcement learning."""

import dataclasses
import math
from dataclasses import dataclass, field
from typing import Literal, get_args

from mjdrive.config.json_files import require

InfractionName = Literal["red_light", "collision", "off_road", "kerb", "wrong_way", "stuck"]
"""What the rules can hold against a drive, as rewards and endings name it."""


@dataclass(frozen=True, slots=True)
class RewardConfig:
    """What each term of the reward weighs; a term of weight 0 is left out of the sum.

    Attributes:
        progress: Reward for a metre driven forwards on a lane that runs the car's way; a metre back takes it away [1/m].
        rewarded_speed: Progress earns no more than at this speed, so that racing does not pay [m/s].
        red_light: Cost of running a red light [-].
        collision: Cost of hitting something [-].
        off_road: Cost of leaving the road [-].
        kerb: Cost of a tyre that strikes a kerb [-].
        wrong_way: Cost of driving against the lane [-].
        stuck: Cost of standing for so long that the rules hold it against the drive [-].
        comfort: Cost of a squared acceleration, along and across the car, for each second that it lasts [s3/m2].
    """

    progress: float = 0.1
    rewarded_speed: float = 8.0
    red_light: float = 5.0
    collision: float = 10.0
    off_road: float = 10.0
    kerb: float = 1.0
    wrong_way: float = 5.0
    stuck: float = 5.0
    comfort: float = 0.01

    def __post_init__(self) -> None:
        for term in dataclasses.fields(self):
            value = getattr(self, term.name)
            require(
                0 <= value < math.inf,
                f"{term.name} of the reward is {value}; expected 0 or more, not infinite. "
                "Costs are taken off the reward, so they are positive.",
            )


@dataclass(frozen=True, slots=True)
class EnvConfig:
    """How an environment rewards and ends a drive; the time limit is Gymnasium's `max_episode_steps`.

    Attributes:
        reward: Weights of the terms of the reward.
        ends_on: Infractions that end the episode (`terminated`); none lets every drive go on to its time limit.
    """

    reward: RewardConfig = field(default_factory=RewardConfig)
    ends_on: tuple[InfractionName, ...] = ("collision", "off_road")

    def __post_init__(self) -> None:
        unknown = sorted(set(self.ends_on) - set(get_args(InfractionName)))
        require(
            not unknown,
            f"ends_on has {', '.join(unknown)}; expected names out of {', '.join(get_args(InfractionName))}.",
        )
