"""What a study measures of a drive, and of what an agent thinks; `mjdrive.study.records.results` holds them all."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class DriveFigures:
    """One drive, as the tables count it.

    Attributes:
        seed: Of the drive [-].
        steps: Control steps [-].
        duration_s: Simulated time [s].
        distance_m: Path length on driving lanes [m].
        red_lights: Red lights run [-].
        lights_met: Times that the car came up to a stop line with a light [-].
        reds_met: Of these, times that the light was red when it came [-].
        collisions: Collisions with things [-].
        kerb_strikes: Kerbs hit [-].
        road_departures: Times that the car left the road [-].
        wrong_ways: Times that it drove against its lane [-].
        off_road_s: Time off the driving lanes [s].
        stuck_s: Time at a standstill with no light to wait for [s].
        penalty: 0.7 to the power of the red lights run [-].
        score: Distance times penalty [m].
        jerk_rms: Root mean square of the jerk [m/s3].
        steering_whiteness: Root mean square of the rate of the steering command [1/s].
        steering_unrest: Root mean square of the rate of that rate [1/s2].
        lane_offset_rms_m: Distance from the centre of the lane while moving outside junctions, root mean square [m].
        branches_taken: How often each way through a junction was driven, by the name of its lane [-].
    """

    seed: int
    steps: int
    duration_s: float
    distance_m: float
    red_lights: int
    lights_met: int
    reds_met: int
    collisions: int
    kerb_strikes: int
    road_departures: int
    wrong_ways: int
    off_road_s: float
    stuck_s: float
    penalty: float
    score: float
    jerk_rms: float
    steering_whiteness: float
    steering_unrest: float
    lane_offset_rms_m: float | None
    branches_taken: Mapping[str, int]


@dataclass(frozen=True, slots=True)
class Curve:
    """A share that grows in steps: from each x on it is the share beside it.

    Attributes:
        x: Rising; what it is, is said where the curve is used.
        share: As many shares, rising [-].
    """

    x: tuple[float, ...]
    share: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Likelihood:
    """How likely an agent finds what the expert does where the agent has never been.

    Attributes:
        frames: Moments looked at [-].
        gain: Mean log probability of the expert's cell of the grid, above that of an agent to whom all cells are alike [nats].
        error: Standard error of that mean, as if the moments were independent [nats].
        junction_gain: The same over the moments in or up to 12 m before a junction; None if there are none [nats].
    """

    frames: int
    gain: float
    error: float
    junction_gain: float | None


@dataclass(frozen=True, slots=True)
class LandscapeFigures:
    """How many ways to act an agent sees at the moments before junctions, on the grid of actions.

    Attributes:
        frames: Moments looked at [-].
        modes: Mean number of separate ways to act with a mass of 5 % or more [-].
        multimodal: Share of the moments with more than one [-].
        heaviest: Mean mass of the heaviest [-].
        entropy: Mean entropy over the grid [bit].
    """

    frames: int
    modes: float
    multimodal: float
    heaviest: float
    entropy: float
