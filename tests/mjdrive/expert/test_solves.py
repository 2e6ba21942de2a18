import json

from mjdrive.expert.solves import OUTCOMES, SolveCounts, SolveWatch


class Solving:
    solver_name = "fatrop"

    def __init__(self) -> None:
        self.solves = SolveCounts(solved=7, failed=1, late=2)


def test_watch_counts_only_the_drive_that_it_saw() -> None:
    expert = Solving()
    first = SolveWatch(expert)
    expert.solves.solved += 3
    second = SolveWatch(expert)
    expert.solves.solved += 1
    expert.solves.recoveries += 2
    expert.solves.late += 1
    assert json.loads(first.metadata()["solves"])["solved"] == 4
    told = second.metadata()
    assert told["solver"] == "fatrop"
    assert json.loads(told["solves"]) == dict.fromkeys(OUTCOMES, 0) | {"solved": 1, "recoveries": 2}
    assert second.late == 1


def test_what_hangs_on_the_machine_is_in_no_file() -> None:
    expert = Solving()
    watch = SolveWatch(expert)
    before = watch.metadata()
    expert.solves.late += 1
    expert.solves.times.append(0.3)
    assert watch.metadata() == before


def test_expert_that_solves_nothing_has_nothing_told_of_it() -> None:
    watch = SolveWatch(object())
    assert (watch.metadata(), watch.late) == ({}, 0)
