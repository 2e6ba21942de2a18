"""Curves over the time and distance of several drives, reckoned by hand."""

import dataclasses

import pytest

from mjdrive.datatypes import Town
from mjdrive.study.assembling import recall_curve
from mjdrive.study.records.drive_records import DriveRecord
from mjdrive.study.records.measures import DriveFigures


def record(duration: float, *passages: tuple[float, str]) -> DriveRecord:
    fields = {it.name: 0 if it.type is int else 0.0 for it in dataclasses.fields(DriveFigures)}
    figures = DriveFigures(**fields | {"duration_s": duration, "branches_taken": {}})  # type: ignore[arg-type]
    return DriveRecord("", figures, 0.0, passages, {}, None)


def test_recall_grows_at_the_first_passage_of_each_way_through_all_drives(town02: Town) -> None:
    ways = [name for name, lane in town02.lanes.items() if lane.junction is not None]
    assert len(ways) == 48
    drives = [
        record(100.0, (10.0, ways[0]), (20.0, ways[0]), (60.0, ways[1])),
        record(50.0, (5.0, ways[1]), (30.0, ways[2])),
    ]
    curve = recall_curve(drives, town02)
    assert curve.x == (0.0, 10.0, 60.0, 130.0, 150.0)
    assert curve.share == pytest.approx((0.0, 1 / 48, 2 / 48, 3 / 48, 3 / 48), abs=1e-6)


def test_who_takes_no_way_recalls_nothing(town02: Town) -> None:
    assert recall_curve([record(30.0)], town02).share == (0.0, 0.0)
