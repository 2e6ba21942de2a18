"""What the drives of an expert are held to: the figures of each, and the file that keeps them."""

import dataclasses
import json
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from jaxtyping import Float

LATEST_START = 1.0
"""A car that waited moves within this time of green [s]."""

SLOW_MS = 50.0
"""A decision that takes longer is slow [ms]."""


@dataclass(frozen=True)
class Job:
    """Expert, car, town, route and light seed of one drive."""

    expert: str
    car: str
    town: str
    route: str
    seed: int

    @property
    def name(self) -> str:
        """All of it in words."""
        return f"{self.expert} {self.car} {self.town} {self.route} seed {self.seed}"


@dataclass(frozen=True)
class Times:
    """How long the decisions of a drive took by one clock.

    Attributes:
        mean_ms: Mean [ms].
        p99_ms: 99 % took less [ms].
        max_ms: The longest [ms].
        slow: Decisions that took longer than `SLOW_MS` [-].
    """

    mean_ms: float = 0.0
    p99_ms: float = 0.0
    max_ms: float = 0.0
    slow: int = 0

    @classmethod
    def of(cls, times: Float[np.ndarray, " T"]) -> "Times":
        """Sum up times [s], one a decision."""
        times_ms = 1000 * times
        return cls(
            mean_ms=rounded(np.mean(times_ms)),
            p99_ms=rounded(np.percentile(times_ms, 99)),
            max_ms=rounded(np.max(times_ms)),
            slow=int(np.count_nonzero(times_ms > SLOW_MS)),
        )


@dataclass(frozen=True)
class Drive:
    """What one drive was like.

    Attributes:
        expert: Who drove.
        car: What was driven.
        town: Where.
        route: Name of the route.
        seed: Of the lights [-].
        steps: Control steps until the end of the route [-].
        off_road_s: Time off the road [s].
        infractions: Kind and cause of each.
        rash_lights: Lights whose line was passed on red, or on a yellow that left room to stop.
        slowest_start_s: Longest time from green until the car moved [s].
        street_offset_rms_m: Distance from the middle of the lane outside junctions, root mean square while it moved [m].
        offset_rms_m: Distance from the route, junctions included, root mean square while it moved [m].
        offset_max_m: The largest such distance [m].
        jerk_rms: Root mean square of the second difference of the speed [m/s3].
        steering_whiteness: Root mean square of the rate of the steering command [1/s].
        steering_unrest: Root mean square of the rate of that rate [1/s2].
        wall: Times of its decisions by the clock.
        cpu: Times of its decisions in CPU time.
        late: Plans that came late [-].
        solver: Who solved; empty for an expert that solves nothing.
        solves: How often solves ended in which way [-].
        reason: Why it did not arrive; empty if it did.
    """

    expert: str
    car: str
    town: str
    route: str
    seed: int
    steps: int = 0
    off_road_s: float = 0.0
    infractions: tuple[str, ...] = ()
    rash_lights: tuple[str, ...] = ()
    slowest_start_s: float = 0.0
    street_offset_rms_m: float = 0.0
    offset_rms_m: float = 0.0
    offset_max_m: float = 0.0
    jerk_rms: float = 0.0
    steering_whiteness: float = 0.0
    steering_unrest: float = 0.0
    wall: Times = Times()
    cpu: Times = Times()
    late: int = 0
    solver: str = ""
    solves: dict[str, int] = field(default_factory=dict)
    reason: str = ""

    @property
    def job(self) -> Job:
        """What was to be driven."""
        return Job(self.expert, self.car, self.town, self.route, self.seed)

    @property
    def flaw(self) -> str:
        """What was wrong with it, in words; empty if it was flawless."""
        flaws = [self.reason] if self.reason else []
        flaws += [f"infraction {name}" for name in self.infractions]
        flaws += [f"rash at light {name}" for name in self.rash_lights]
        if self.off_road_s > 0:
            flaws.append(f"{self.off_road_s:.1f} s off road")
        if self.slowest_start_s > LATEST_START:
            flaws.append(f"start {self.slowest_start_s:.1f} s after green")
        return ", ".join(flaws)


@dataclass(frozen=True)
class Checks:
    """Checked drives, and what they were made with.

    Attributes:
        code: SHA-256 of the sources, hexadecimal.
        car_digest: SHA-256 of the car's MJCF, hexadecimal.
        town_digests: Digest of each town by its name.
        machine: Where they were driven, which bears on the times: processor, cores, system, versions, load at the start.
        drives: Each of them.
    """

    code: str
    car_digest: str
    town_digests: dict[str, str]
    machine: dict[str, Any]
    drives: tuple[Drive, ...] = ()

    def to_text(self) -> str:
        """As JSON, a line a drive."""
        made_with = {**dataclasses.asdict(self), "drives": []}
        lines = ",\n".join(json.dumps(dataclasses.asdict(it)) for it in self.drives)
        return (
            json.dumps(made_with, indent=1).replace('"drives": []', f'"drives": [\n{lines}\n]')
            + "\n"
        )

    def is_like(self, other: "Checks") -> bool:
        """Whether drives of both can stand in one file: same code, car, towns, versions and processor."""
        return (
            (self.code, self.car_digest) == (other.code, other.car_digest)
            and self.town_digests == other.town_digests
            and all(self.machine[it] == other.machine[it] for it in ("processor", "versions"))
        )


def rounded(value: float | np.floating) -> float:
    """Drop the digits that carry no meaning."""
    return round(float(value), 4)
