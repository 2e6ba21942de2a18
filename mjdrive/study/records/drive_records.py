"""What a study keeps of each drive: its figures, and when and where it came by what is counted over several drives."""

from collections.abc import Mapping
from dataclasses import dataclass

from mjdrive.datatypes import Episode, InfractionKind, Town
from mjdrive.evaluation import lane_keeping
from mjdrive.evaluation.branches import branch_passages
from mjdrive.evaluation.comfort import comfort
from mjdrive.evaluation.coverage import distance_along, first_visits
from mjdrive.evaluation.lights_met import lights_met
from mjdrive.evaluation.metrics import RED_LIGHT_FACTOR, control_interval, summarise
from mjdrive.study.records.fans import thinned_path
from mjdrive.study.records.measures import DriveFigures
from mjdrive.study.records.results import DrivenPath

_MISHAPS = (InfractionKind.COLLISION, InfractionKind.OFF_ROAD)

PATH_STEPS = 30_000
"""Control steps that a path shows, as many as the paper's figure [-]."""


@dataclass(frozen=True, slots=True)
class DriveRecord:
    """One drive of a study.

    Attributes:
        digest: SHA-256 of the weights that drove, hexadecimal; empty for a reference.
        figures: As the tables count it.
        length_m: Path length on driving lanes, for what is counted over it [m].
        passages: When a way through a junction was driven to its end [s], and the name of its lane.
        visits: After which distance each directed lane was first visited [m], by name.
        path: Where its first `PATH_STEPS` led; None where nobody looks at it.
    """

    digest: str
    figures: DriveFigures
    length_m: float
    passages: tuple[tuple[float, str], ...]
    visits: Mapping[str, float]
    path: DrivenPath | None


def record(
    episode: Episode, town: Town, *, digest: str, path_of: tuple[str, int] | None
) -> DriveRecord:
    """Measure a drive.

    Args:
        episode: The drive.
        town: Where.
        digest: SHA-256 of the weights that drove, hexadecimal.
        path_of: Arm and training seed if the path is to be kept.
    """
    lanes = lane_keeping.track(episode, town)
    interval = control_interval(episode)
    start = float(episode.time[0])
    return DriveRecord(
        digest=digest,
        figures=_figures(episode, town, interval),
        length_m=round(float(distance_along(episode)[-1]), 4),
        passages=tuple(
            (round(float(episode.time[step]) - start, 4), lane)
            for step, lane in branch_passages(episode, town)
        ),
        visits={
            name: round(distance, 4)
            for name, distance in first_visits(episode, lanes, town).items()
        },
        path=None if path_of is None else _path(episode, *path_of),
    )


def _figures(episode: Episode, town: Town, interval: float) -> DriveFigures:
    summary = summarise(episode, town)
    met = lights_met(episode, town)
    smooth = comfort(episode, interval=interval)
    return DriveFigures(
        seed=summary.seed,
        steps=summary.steps,
        duration_s=summary.duration_s,
        distance_m=summary.distance_m,
        red_lights=summary.red_lights,
        lights_met=met.lights,
        reds_met=met.reds,
        collisions=summary.collisions,
        kerb_strikes=summary.kerb_strikes,
        road_departures=summary.road_departures,
        wrong_ways=summary.wrong_ways,
        off_road_s=summary.off_road_s,
        stuck_s=summary.stuck_s,
        penalty=round(RED_LIGHT_FACTOR**summary.red_lights, 6),
        score=summary.score,
        jerk_rms=round(smooth.jerk_rms, 6),
        steering_whiteness=round(smooth.steering_whiteness, 6),
        steering_unrest=round(smooth.steering_unrest, 6),
        lane_offset_rms_m=summary.lane_keeping.offset_rms_m,
        branches_taken=summary.branches_taken,
    )


def _path(episode: Episode, arm: str, seed: int) -> DrivenPath:
    interval = control_interval(episode)
    steps = min(len(episode.time), PATH_STEPS)
    end = float(episode.time[0]) + (steps + 0.5) * interval  # what the last step did counts, too

    def places(*kinds: InfractionKind) -> tuple[tuple[float, float], ...]:
        return tuple(
            (round(it.x, 2), round(it.y, 2))
            for it in episode.infractions
            if it.kind in kinds and it.time < end
        )

    return DrivenPath(
        arm=arm,
        seed=seed,
        town=episode.town,
        duration_s=round(steps * interval, 4),
        points=thinned_path(episode, steps=steps),
        red_lights=places(InfractionKind.RED_LIGHT),
        mishaps=places(*_MISHAPS),
    )
