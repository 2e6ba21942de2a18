"""The command that holds experts to their bars; the drives are made up."""

import dataclasses
import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import ModuleType

import pytest
from click.testing import CliRunner, Result

from mjdrive.evaluation.expert_checks import Checking
from mjdrive.evaluation.expert_drives import Drive, Job, Times

CALM = {"jerk_rms": 1.0, "steering_unrest": 0.2, "steering_whiteness": 0.04}
WILD = {"jerk_rms": 3.0, "steering_unrest": 0.8, "steering_whiteness": 0.1}


class Pretending:
    """Drives nothing, and says what drives were like."""

    def __init__(self, **changes: object) -> None:
        self.changes = changes
        self.jobs: list[Job] = []

    def run(
        self, work: Checking, jobs: Sequence[Job], *, on_progress: Callable[[Job, int], None]
    ) -> Iterator[tuple[Job, Drive]]:
        for job in jobs:
            self.jobs.append(job)
            figures = {
                **(CALM if job.expert == "mpc" else WILD),
                "steps": 2000,
                "offset_rms_m": 0.1,
            }
            figures |= {"wall": Times(mean_ms=3.0)} | (self.changes if job.expert == "mpc" else {})
            yield job, Drive(**dataclasses.asdict(job), **figures)


@pytest.fixture
def check(
    load_script: Callable[[str], ModuleType], monkeypatch: pytest.MonkeyPatch
) -> Callable[..., Result]:
    script = load_script("check_experts")

    def run(executor: Pretending, *words: str) -> Result:
        monkeypatch.setattr(script, "chosen_executor", lambda *_: executor)
        words = ("--expert", "pid", "--expert", "mpc", "--town", "town02", *words)
        return CliRunner().invoke(script.main, words, catch_exceptions=False)

    return run


def test_all_is_well(check: Callable[..., Result]) -> None:
    drives = Pretending()
    done = check(drives, "--seeds", "2")
    assert done.exit_code == 0, done.output
    assert len(drives.jobs) == 2 * 2 * 6
    assert "12 by the PID (light seeds 0, 1), 12 by the MPC (light seeds 0, 1)" in done.output
    assert "| mpc | town02 | 12 of 12 |" in done.output


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"jerk_rms": 2.0}, "mpc town02: jerk, of the PID's 0.667; expected at most 0.5"),
        ({"offset_rms_m": 0.3}, "mpc town02: lane error of a drive, RMS 0.3 m; expected at most"),
        ({"wall": Times(mean_ms=21.0)}, "mpc town02: mean time of a decision 21 ms; expected"),
        ({"wall": Times(slow=21)}, "mpc town02: decisions over 50 ms, of 100 1.05; expected"),
        ({"off_road_s": 0.2}, "mpc default town02 route0 seed 0: 0.2 s off road"),
        ({"slowest_start_s": 1.1}, "mpc default town02 route0 seed 0: start 1.1 s after green"),
    ],
)
def test_what_is_not_as_it_should_be_is_named(
    change: dict[str, object], told: str, check: Callable[..., Result]
) -> None:
    done = check(Pretending(**change), "--seeds", "1")
    assert done.exit_code == 1
    assert told in done.output
    assert "Everything else" not in done.output


def test_bar_that_is_known_not_to_be_held_is_told_and_not_counted(
    check: Callable[..., Result],
) -> None:
    done = check(Pretending(steering_whiteness=0.09), "--seeds", "1")
    assert done.exit_code == 0
    assert "not counted: mpc town02: steering whiteness, of the PID's 0.9" in done.output


def test_busy_machine_can_be_judged_by_cpu_time(check: Callable[..., Result]) -> None:
    done = check(Pretending(wall=Times(mean_ms=21.0)), "--seeds", "1", "--clock", "cpu")
    assert done.exit_code == 0
    assert "not counted: mpc town02: mean time of a decision 21 ms" in done.output


def test_interrupted_check_goes_on_and_keeps_what_was_driven(
    check: Callable[..., Result], tmp_path: Path
) -> None:
    out = tmp_path / "checks.json"
    check(Pretending(), "--seeds", "2", "--out", str(out))
    kept = json.loads(out.read_text())
    last = kept["drives"].pop()
    out.write_text(json.dumps(kept))
    again = Pretending()
    check(again, "--seeds", "1", "--out", str(out))
    assert again.jobs == []
    check(again, "--seeds", "2", "--out", str(out))
    assert [(it.expert, it.route, it.seed) for it in again.jobs] == [("mpc", last["route"], 1)]
    assert len(json.loads(out.read_text())["drives"]) == 24


def test_drives_of_other_code_are_not_gone_on_with(
    check: Callable[..., Result], tmp_path: Path
) -> None:
    out = tmp_path / "checks.json"
    check(Pretending(), "--seeds", "1", "--out", str(out))
    kept = json.loads(out.read_text())
    out.write_text(json.dumps({**kept, "code": "0" * 64}))
    again = Pretending()
    done = check(again, "--seeds", "1", "--out", str(out))
    assert len(again.jobs) == 12
    assert "all is driven again" in done.output
