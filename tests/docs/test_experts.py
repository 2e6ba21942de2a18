"""docs/experts.md says of the experts what was measured."""

from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from mjdrive.config import read_json
from mjdrive.evaluation.expert_bars import bars
from mjdrive.evaluation.expert_drives import Checks
from mjdrive.evaluation.steering_bound import Bounds
from mjdrive.town import library
from mjdrive.vehicle import cars

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs/experts.md").read_text()
CHECKS = read_json(Checks, ROOT / "docs/experts/checks.json")
BOUNDS = read_json(Bounds, ROOT / "docs/experts/steering_bound.json")
ROUTES = {
    (town, name) for town in ("town01", "town02") for name in library.load_settings(town).routes
}


@pytest.fixture
def script(load_script: Callable[[str], ModuleType]) -> ModuleType:
    return load_script("expert_tables")


def test_tables_are_those_that_were_measured(script: ModuleType) -> None:
    assert all(f"<!-- {mark}: begin -->" in PAGE for mark in script.tables())
    assert script.with_tables(PAGE) == PAGE, "run: python scripts/expert_tables.py"


def test_every_route_was_driven_by_both_experts_and_no_drive_had_a_flaw() -> None:
    for expert in ("pid", "mpc"):
        assert {(it.town, it.route) for it in CHECKS.drives if it.expert == expert} == ROUTES
    assert [it.job.name for it in CHECKS.drives if it.flaw] == []


def test_checks_are_of_this_car_and_these_towns() -> None:
    assert CHECKS.car_digest == cars.load().digest, "run: python scripts/check_experts.py"
    for town, digest in CHECKS.town_digests.items():
        assert library.load(town).digest == digest, f"{town} changed since"


def test_every_bar_is_held_but_those_that_the_page_owns_up_to() -> None:
    missed = {it.figure for it in bars(CHECKS.drives, clock="cpu") if not it.holds}
    assert missed <= {"steering whiteness, of the PID's", "decisions over 50 ms, of 100"}
    assert "steering whiteness" in PAGE.partition("## MPC")[2][:600]


def test_half_of_the_pids_whiteness_is_out_of_reach_on_most_routes_at_its_speeds() -> None:
    assert {tuple(it.route.split("/")) for it in BOUNDS.bounds} == ROUTES
    reached: dict[float, int] = {}
    for bound in BOUNDS.bounds:
        for least in bound.least[1::2]:
            assert least.allowance == 0.25
            assert least.other_start == pytest.approx(least.whiteness, rel=1e-3)
            reached[least.pace] = reached.get(least.pace, 0) + (
                least.whiteness <= 0.5 * bound.whiteness
            )
    assert reached == {1.0: 1, 0.9: 13, 0.8: 15}  # as the page says


def test_ten_routes_take_the_pid_as_long_as_the_paper() -> None:
    laps: dict[int, list[int]] = {}
    for it in CHECKS.drives:
        if (it.expert, it.town) == ("pid", "town01"):
            laps.setdefault(it.seed, []).append(it.steps)
    whole = [0.1 * sum(steps) for steps in laps.values() if len(steps) == 10]
    assert abs(sum(whole) / len(whole) - 2100.0) <= 170.0
