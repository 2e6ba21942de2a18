"""What the evidence of tuned settings says of them; tests/mjdrive/cli/test_tune.py has the file and its refusals."""

import dataclasses

import pytest

from mjdrive.tuning.gains import Evidence, Gains
from mjdrive.tuning.marks import Marks

BEFORE = Marks(0.16, 0.5, 0.3, 2.9, 60.0, 0.1, 0, 4.6)


def tuned(**checked: float) -> Gains:
    """Settings that drive town02, on which they were checked, so."""
    here = Evidence("town01", "1", before=BEFORE, after=dataclasses.replace(BEFORE, cost=3.5))
    there = Evidence("town02", "2", BEFORE, dataclasses.replace(BEFORE, **checked))  # type: ignore[arg-type]
    return Gains("pid", "default", "", {}, (), here, there, 2, 0, {}, {})


@pytest.mark.parametrize("worse", [{"cost": 46.2}, {"mishaps": 2}])
def test_settings_that_drive_another_town_worse_are_doubted(worse: dict[str, float]) -> None:
    doubt = tuned(**worse).doubt
    assert doubt.startswith("In town02, which the search never saw")
    assert "`mjdrive tune pid --town town02 --check-town town01`" in doubt


def test_settings_that_drive_it_no_worse_or_were_not_checked_are_not() -> None:
    assert tuned(cost=4.61).doubt == tuned(cost=4.0).doubt == ""
    assert dataclasses.replace(tuned(cost=46.2), checked_on=None).doubt == ""


def test_the_town_that_was_searched_on_says_nothing_new() -> None:
    gains = tuned(cost=46.2)
    assert dataclasses.replace(gains, tuned_on=gains.checked_on).doubt == ""
