"""A whole study on a real Ray cluster of two nodes on this machine, and on machines that see nothing of its folder."""

import hashlib
import logging
import pickle
import signal
from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import ray

from mjdrive.config import StudyConfig
from mjdrive.execution.executors import executor_for
from mjdrive.execution.work import Executor
from mjdrive.study.jobs import drivers
from mjdrive.study.study import Study

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(
        900
    ),  # each stage starts processes of its own, on a machine that may be busy
]
TIMES = ("metrics.jsonl",)
"""Files that tell how long something took, which is never twice the same."""


@dataclass
class Elsewhere:
    """Does jobs while the folder of the study is out of sight; what work and jobs hold comes over as on a cluster."""

    folder: Path

    def run(
        self, work: Any, jobs: Sequence[Any], *, on_progress: Callable[[Any, int], None]
    ) -> Generator[tuple[Any, Any]]:
        luggage = [pickle.dumps(it) for it in (work, *jobs)]
        drivers.load_pilot.cache_clear()
        hidden = self.folder.rename(self.folder.with_name("hidden"))
        try:
            there, *jobs_there = (pickle.loads(it) for it in luggage)
            do = there.begin()
            results = [do(job, lambda done: None) for job in jobs_there]
        finally:
            hidden.rename(self.folder)
            drivers.load_pilot.cache_clear()
        yield from zip(jobs, results, strict=True)


@pytest.fixture
def cwd(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to work in, which is not that of the processes of a cluster, so that names in it mean nothing to them."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def joined_address(ray_address: str) -> Iterator[str]:
    """A cluster that this process has joined for all stages, so that these need no new processes each."""
    at_sigterm = signal.getsignal(signal.SIGTERM)
    ray.init(address=ray_address, logging_level=logging.ERROR, log_to_driver=False)
    yield ray_address
    ray.shutdown()
    signal.signal(signal.SIGTERM, at_sigterm)


def quietly(stage: str, count: int) -> Callable[[str, int, int], None]:
    return lambda thing, done, expected: None


def digests(folder: Path) -> dict[str, str]:
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name not in TIMES
    }


def test_a_study_on_ray_is_that_of_one_process_byte_for_byte(
    joined_address: str,
    tiniest: StudyConfig,
    tiniest_folder: Path,
    cwd: Path,
    caplog: pytest.LogCaptureFixture,
) -> None:
    told: list[tuple[str, str]] = []

    def stage(name: str, count: int) -> Callable[[str, int, int], None]:
        return lambda thing, done, expected: (
            told.append((name, thing)) if done == expected else None
        )

    executor = executor_for(jobs=None, backend="ray", address=joined_address)
    with caplog.at_level(logging.WARNING, logger="mjdrive"):
        Study(tiniest, Path("study"), executor=executor).run(stage)
    assert digests(cwd / "study") == digests(tiniest_folder)
    assert not any("trained here" in it for it in caplog.messages), "who sees the folder trains"
    assert {("train", "bc-beta-3"), ("drive", "bc-beta-sample-3, episode-001")} < set(told)


def test_agents_are_trained_here_and_everything_else_is_done_there_with_the_same_bytes(
    tiniest: StudyConfig,
    tiniest_folder: Path,
    tmp_path: Path,
    caplog: pytest.LogCaptureFixture,
) -> None:
    folder = tmp_path / "study"
    executor = Elsewhere(folder)
    assert isinstance(executor, Executor)
    with caplog.at_level(logging.WARNING, logger="mjdrive"):
        Study(tiniest, folder, executor=executor).run(quietly)
    assert digests(folder) == digests(tiniest_folder)
    (note,) = (it for it in caplog.messages if "trained here" in it)
    assert note.startswith("Agents are trained here")
    assert f"of the cluster does not see '{folder / 'runs'}'" in note
