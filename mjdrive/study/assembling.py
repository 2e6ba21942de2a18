"""Put together what a study found: `results.json` and the files beside it that pictures are made from."""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from mjdrive.config import StudyConfig, write_json
from mjdrive.datatypes import Town
from mjdrive.episodes import dataset
from mjdrive.evaluation.branches import branches_taken
from mjdrive.evaluation.choices import ChoiceStatistics, choice_statistics
from mjdrive.evaluation.coverage import joined_coverage, reachable_lanes
from mjdrive.study.jobs import driving, forks, judging
from mjdrive.study.jobs.driving import DriveJob
from mjdrive.study.jobs.forks import ForkRecord
from mjdrive.study.jobs.judging import JudgeRecord
from mjdrive.study.plan import ArmPlan, ProgressPlan
from mjdrive.study.records import results
from mjdrive.study.records.drive_records import DriveRecord
from mjdrive.study.records.measures import Curve
from mjdrive.study.records.results import ArmResult, DataResult, ProgressPoint, StudyResults
from mjdrive.town import library

_DIGITS = 6
"""Decimals of the points of a curve."""


def assemble(
    config: StudyConfig,
    folder: Path,
    *,
    town: Town,
    data: Mapping[str, Path],
    references: Sequence[ArmPlan],
    arms: Sequence[ArmPlan],
    progress: Sequence[ProgressPlan],
) -> StudyResults:
    """Read everything that a study left and write its results.

    Args:
        config: Settings of the study.
        folder: Its folder.
        town: Where was driven.
        data: Folder of each data set that was learnt from, by name.
        references: What the references did.
        arms: What the agents did.
        progress: What their checkpoints did.

    Returns:
        The results, as they are in `results.json` now.
    """
    asked = [judging.read_record(plan.judge) for plan in arms if plan.judge is not None]
    lived = [_fork_records(plan) for plan in arms]
    paths = [_write_path(plan, folder) for plan in (*references, *arms)]
    found = StudyResults(
        data=tuple(data_result(name, place, config) for name, place in data.items()),
        references=tuple(_arm_result(plan, (), None, town, config) for plan in references),
        arms=tuple(
            _arm_result(plan, records, judged, town, config)
            for plan, records, judged in zip(arms, lived, asked, strict=True)
        ),
        pooled={
            name: _choices(taken, town, config)
            for name, taken in _pooled([*references, *arms]).items()
        },
        progress=tuple(_progress_point(plan) for plan in progress),
        turns=tuple(turn for records in lived for it in records for turn in it.turns),
        landscapes=tuple(
            f"{results.LANDSCAPES}/{name}"
            for judged in asked
            if judged is not None
            for name in judged.landscapes
        ),
        paths=tuple(path for path in paths if path is not None),
        fans=tuple(
            name
            for plan, records in zip(arms, lived, strict=True)
            for name in _write_fans(plan, records, folder)
        ),
    )
    write_json(found, folder / results.RESULTS)
    return found


def data_result(name: str, place: Path, config: StudyConfig) -> DataResult:
    """Describe a data set, and the turns that its expert took.

    Args:
        name: Of the data set in the study.
        place: Its folder.
        config: Settings of the study.

    Raises:
        DataError: If it is missing, unfinished or damaged.
    """
    manifest, episodes = dataset.read_dataset(place)
    town = library.load(manifest.town)
    taken: Counter[str] = Counter()
    for episode in episodes:
        taken.update(branches_taken(episode, town))
    return DataResult(
        name=name,
        town=town.name,
        episodes=len(episodes),
        samples=sum(len(episode.time) for episode in episodes),
        manifest_sha256=dataset.digest(place),
        choices=_choices(taken, town, config),
    )


def recall_curve(records: Sequence[DriveRecord], town: Town) -> Curve:
    """Branch recall over the time of several drives, one after the other; x in [s].

    Args:
        records: The drives.
        town: Where.
    """
    branches = sum(lane.junction is not None for lane in town.lanes.values())
    seen: set[str] = set()
    times, begun = [0.0], 0.0
    for it in records:
        for time, lane in it.passages:
            if lane not in seen:
                seen.add(lane)
                times.append(begun + time)
        begun += it.figures.duration_s
    shares = [count / branches for count in range(len(times))]
    return _curve([*times, begun], [*shares, shares[-1]])


def _curve(x: Sequence[float], share: Sequence[float]) -> Curve:
    return Curve(
        tuple(round(float(it), _DIGITS) for it in x),
        tuple(round(float(it), _DIGITS) for it in share),
    )


def _coverage_curve(records: Sequence[DriveRecord], town: Town) -> Curve:
    """Share of the directed lanes visited over the distance of several drives, one after the other; x in [km].

    Args:
        records: The drives.
        town: Where.
    """
    joined = joined_coverage(
        [it.visits for it in records],
        [it.length_m for it in records],
        num_lanes=len(reachable_lanes(town)),
    )
    return _curve(joined.distance_km.tolist(), joined.share.tolist())


def _arm_result(
    plan: ArmPlan,
    forked: Sequence[ForkRecord],
    judged: JudgeRecord | None,
    town: Town,
    config: StudyConfig,
) -> ArmResult:
    drives = [_record(job) for job in plan.drives]
    long_drives = [_record(job) for job in plan.all_drives[len(drives) :]]
    everything = [*drives, *long_drives]
    return ArmResult(
        arm=plan.it.arm.name if plan.it is not None else str(plan.who.reference),
        variant=plan.it.agent.variant.name if plan.it is not None else "",
        seed=plan.it.agent.seed if plan.it is not None else plan.who.walk,
        digest=plan.who.digest,
        drives=tuple(it.figures for it in drives),
        long_drive=long_drives[0].figures if long_drives else None,
        choices=_choices(_taken(drives), town, config),
        all_choices=_choices(_taken(everything), town, config),
        recall=recall_curve(everything, town),
        coverage=_coverage_curve(drives, town),
        all_coverage=_coverage_curve(everything, town),
        forks=tuple(it.outcome for it in forked if it.outcome is not None),
        likelihood=None if judged is None else judged.likelihood,
        landscape=None if judged is None else judged.landscape,
    )


def _progress_point(plan: ProgressPlan) -> ProgressPoint:
    return ProgressPoint(
        arm=plan.arm,
        variant=plan.variant,
        seed=plan.seed,
        epoch=plan.epoch,
        loss=plan.loss,
        drives=tuple(_record(job).figures for job in plan.drives),
    )


def _pooled(plans: Sequence[ArmPlan]) -> dict[str, Counter[str]]:
    """How often all agents of each arm together drove each way in the drives of the tables."""
    pooled: dict[str, Counter[str]] = {}
    for plan in plans:
        name = plan.it.arm.name if plan.it is not None else str(plan.who.reference)
        taken = _taken([_record(job) for job in plan.drives])
        pooled.setdefault(name, Counter()).update(taken)
    return pooled


def _taken(records: Sequence[DriveRecord]) -> Counter[str]:
    counts: Counter[str] = Counter()
    for it in records:
        counts.update(it.figures.branches_taken)
    return counts


def _choices(taken: Mapping[str, int], town: Town, config: StudyConfig) -> ChoiceStatistics:
    return choice_statistics(taken, town, rng=np.random.default_rng(config.seed))


def _record(job: DriveJob) -> DriveRecord:
    found = driving.read_record(job)
    assert found is not None, "results are put together after all drives"
    return found


def _fork_records(plan: ArmPlan) -> tuple[ForkRecord, ...]:
    found = [forks.read_record(job) for job in plan.forks]
    return tuple(it for it in found if it is not None)


def _write_path(plan: ArmPlan, folder: Path) -> str | None:
    """Write where the long drive led, and say in which file."""
    if plan.long_drive is None:
        return None
    path = _record(plan.long_drive).path
    assert path is not None, "long drives keep their path"
    name = f"{results.PATHS}/{plan.who.name}.json"
    write_json(path, folder / name)
    return name


def _write_fans(plan: ArmPlan, records: Sequence[ForkRecord], folder: Path) -> list[str]:
    """Write the ways that were taken from the moment of the turns, and say in which files."""
    names = []
    for index, (job, it) in enumerate(zip(plan.forks, records, strict=True)):
        if job.turns is not None and it.fan is not None:
            names.append(f"{results.FANS}/{plan.who.name}-{index}.json")
            write_json(it.fan, folder / names[-1])
    return names
