"""A whole study: demonstrations, training, drives and judgement, tables and report, each gone on with where it stopped."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from mjdrive import versions
from mjdrive.config import StudyConfig
from mjdrive.datatypes import Town
from mjdrive.episodes import dataset
from mjdrive.errors import DataError, UnknownNameError
from mjdrive.execution.serial import SerialExecutor
from mjdrive.execution.work import Executor
from mjdrive.study.assembling import assemble
from mjdrive.study.jobs import checkpoints
from mjdrive.study.jobs.collecting import collections
from mjdrive.study.jobs.drivers import load_learner
from mjdrive.study.jobs.driving import Place, drive_all
from mjdrive.study.jobs.forks import live_forks
from mjdrive.study.jobs.judging import Judging, judge_all
from mjdrive.study.jobs.sharing import Report
from mjdrive.study.jobs.training import train_all, training_job
from mjdrive.study.plan import ArmPlan, plan_arms, plan_progress, plan_references
from mjdrive.study.records.folder import HELD_OUT, StudyFolder, begin
from mjdrive.study.records.results import StudyRecord, StudyResults
from mjdrive.study.records.situations import situations
from mjdrive.study.report.report import write_report
from mjdrive.study.settings.agents import agents, learner_config, require_buildable
from mjdrive.study.videos import videos
from mjdrive.town import library
from mjdrive.vehicle import cars
from models.config import Precision
from models.energy_scoring import resolved
from models.hardware import choose_device

Stage = Callable[[str, int], Report]
"""Told that a stage begins, and of how many things it consists; what comes back is told how far each of them is."""


@dataclass(frozen=True, eq=False)
class Study:
    """A study to run, or to go on with.

    Attributes:
        config: All that decides its results.
        folder: Where everything goes.
        data: Folders of data sets that are there already, by name; the study collects the others.
        trained: Folder with trained runs; agents that have none there are trained in the study.
        executor: Where drives are made and, if folders are shared there, agents are trained; the drives do not depend on it.
        command: What was typed to begin it, for the report; empty if nothing was.
    """

    config: StudyConfig
    folder: Path
    data: Mapping[str, Path] = field(default_factory=dict)
    trained: Path | None = None
    executor: Executor = field(default_factory=SerialExecutor)
    command: str = ""

    def run(self, stage: Stage) -> StudyResults:
        """Do what is missing.

        Args:
            stage: Told how far the study is.

        Returns:
            The results, which are in `results.json`, too.

        Raises:
            ConfigError: If a setting has no meaning.
            DataError: If the folder holds something else, or a data set is damaged.
            RouteError: If no junction of the town leaves a choice of two, or the town has no routes to learn from.
            RunError: If a trained run is not what the study says.
            UnknownNameError: If there is no such town, method, preset, data set or setting.
            WorkerError: If a process was lost.
        """
        require_buildable(self.config)
        # Later stages look at them, so a town without any is refused.
        situations(library.load(self.config.town))
        self._require_data()
        given = self._given_runs()
        begin(self.folder, self._record(given))
        data = self._collect(stage)
        runs = self._train(data, given, stage)
        return self._evaluate(data, runs, stage)

    @property
    def _names(self) -> StudyFolder:
        return StudyFolder(self.folder)

    def _require_data(self) -> None:
        """Refuse data sets that nobody learns from, and those that are unfinished."""
        known = {it.name for it in self.config.demonstrations}
        for name, place in self.data.items():
            if name not in known:
                raise UnknownNameError("data set of the study", name, known)
            town = dataset.read_manifest(place).town
            if town != self.config.learning_town:
                raise DataError(
                    f"Data set '{place}' was driven in {town}; expected {self.config.learning_town}. Give another one "
                    f"with --data, or set learning_town={town}."
                )

    def _given_runs(self) -> dict[str, Path]:
        """Runs that were trained before, by the name of their agent."""
        if self.trained is None:
            return {}
        if not self.trained.is_dir():
            raise DataError(
                f"There is no folder '{self.trained}'; expected one with trained runs. Give another one with --runs."
            )
        found = {}
        for it in agents(self.config):
            run = checkpoints.find_run(it, self.trained)
            if run is not None:
                checkpoints.require_planned(run, it, learner_config(it.variant))
                found[it.name] = run
        return found

    def _record(self, given: Mapping[str, Path]) -> StudyRecord:
        names = sorted({self.config.town, self.config.learning_town})
        return StudyRecord(
            settings=self.config,
            learners={
                it.name: checkpoints.effective_settings(learner_config(it))
                for it in self.config.variants
            },
            versions=versions.all_versions(),
            code=versions.code_digest(),
            precision=_precision(),
            device=choose_device().type,
            towns={name: library.load(name).digest for name in names},
            car=cars.load().digest,
            data={name: dataset.digest(place) for name, place in self.data.items()},
            runs={name: checkpoints.digest(run) for name, run in given.items()},
            command=self.command,
        )

    def _collect(self, stage: Stage) -> dict[str, Path]:
        """Collect the data sets that are not given, and the expert's walk that nobody learns from."""
        wanted = collections(self.config, self._names, given=self.data)
        report = stage("collect", sum(it.num_episodes for it in wanted))
        for it in wanted:
            it.collect(executor=self.executor, report=report)
        names = [it.name for it in self.config.demonstrations]
        return {name: self.data.get(name, self._names.data(name)) for name in names}

    def _train(
        self, data: Mapping[str, Path], given: Mapping[str, Path], stage: Stage
    ) -> dict[str, Path]:
        """Train the agents that are not trained yet."""
        digests = {name: dataset.digest(place) for name, place in data.items()}
        samples = {name: _samples(place) for name, place in data.items()}
        runs: dict[str, Path] = {}
        jobs = []
        for it in agents(self.config):
            run = runs[it.name] = given.get(it.name, self._names.run(it.name))
            name = it.variant.demonstrations
            if checkpoints.is_complete(run):
                checkpoints.require_planned(run, it, learner_config(it.variant))
                checkpoints.require_trained_on(run, it, manifest_sha256=digests[name])
            else:
                jobs.append(
                    training_job(it, data[name], run, config=self.config, num_samples=samples[name])
                )
        report = stage("train", len(jobs))
        train_all(jobs, executor=self.executor, report=report)
        return runs

    def _evaluate(
        self, data: Mapping[str, Path], runs: dict[str, Path], stage: Stage
    ) -> StudyResults:
        """Drive, ask, and put everything together."""
        town = library.load(self.config.town)
        place = Place(town, cars.load(), versions.all_versions())
        references = plan_references(self.config, self._names)
        arms = plan_arms(self.config, self._names, runs, town, precision=_precision())
        progress = plan_progress(self.config, self._names, runs, precision=_precision())
        drives = [job for it in (*references, *arms) for job in it.all_drives]
        drives += [job for it in progress for job in it.drives]
        drive_all(place, drives, executor=self.executor, report=stage("drive", len(drives)))
        forks = [job for it in arms for job in it.forks]
        live_forks(
            place, forks, executor=self.executor, report=stage("live moments again", len(forks))
        )
        self._judge(place, arms, stage)
        found = assemble(
            self.config,
            self.folder,
            town=town,
            data=data,
            references=references,
            arms=arms,
            progress=progress,
        )
        self._show(found, arms, town, stage)
        return found

    def _show(
        self, found: StudyResults, arms: tuple[ArmPlan, ...], town: Town, stage: Stage
    ) -> None:
        """Write videos, tables, pictures and the report."""
        who = {(it.it.arm.name, it.it.agent.seed): it.who for it in arms if it.it is not None}
        agents_seen = len({(turn.arm, turn.seed) for turn in found.turns})
        report = stage("videos", agents_seen)
        videos.write_videos(
            found.turns,
            lambda arm, seed: load_learner(who[arm, seed]),
            {arm.name: arm.label for arm in self.config.arms},
            town,
            self.folder,
            weights_of=lambda arm, seed: who[arm, seed].digest,
            on_video=lambda done: report(f"video {done}", 1, 1),
        )
        report = stage("report", 1)
        write_report(self.folder)
        report("report", 1, 1)

    def _judge(self, place: Place, arms: tuple[ArmPlan, ...], stage: Stage) -> None:
        jobs = [it.judge for it in arms if it.judge is not None]
        walk = (
            dataset.read_dataset(self._names.data(HELD_OUT))[1] if self.config.held_out_km else ()
        )
        work = Judging(place, tuple(walk), self.config.held_out_frames, self.config.seed)
        judge_all(work, jobs, executor=self.executor, report=stage("judge", len(jobs)))


def _precision() -> Precision:
    """What an open number format means in a study: drives are made on the CPU, so that of the CPU."""
    return resolved("auto", "cpu")


def _samples(place: Path) -> int:
    return sum(entry.steps for entry in dataset.read_manifest(place).episodes)
