"""docs/cars.md says what the code does."""

import json
import re
from pathlib import Path

import pytest

from mjdrive.cli.car_tables import number
from mjdrive.vehicle import cars
from mjdrive.vehicle.car_parts import PARTS

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs/cars.md").read_text()
REPORT = json.loads((ROOT / "docs/car_mkz/report.json").read_text())


def rows(text: str) -> list[list[str]]:
    """Cells of every table row, header rows left out."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return [row for row in cells if not set("".join(row)) <= {"-"}][1:]


def test_list_of_names_is_the_one_in_the_code():
    listed = PAGE.partition("<!-- parts: begin -->")[2].partition("<!-- parts: end -->")[0]
    assert rows(listed) == [[part.kind, f"`{part.name}`", part.purpose] for part in PARTS]


def test_every_shipped_car_is_in_the_table():
    table = PAGE.partition("## Choose a car")[2].partition("\n\nThe MJCF")[0]
    for name in cars.SHIPPED:
        car = cars.load(name).parameters
        (row,) = [row for row in rows(table) if row[0] == f"`{name}`"]
        assert row[2:4] == [f"{car.mass:,.0f} kg", f"{car.wheelbase:.2f} m"]
        assert row[4] == f"{car.max_steering_angle:.2f} rad, {car.max_steering_rate:.2f} rad/s"


@pytest.mark.parametrize(
    ("row", "field", "pattern"),
    [
        ("mass", "mass", r"([\d,.]+) kg"),
        ("wheelbase", "wheelbase", r"([\d.]+) m"),
        ("length", "length", r"([\d.]+) m"),
        ("rear overhang", "rear_overhang", r"([\d.]+) m"),
        ("width", "width", r"([\d.]+) m"),
        ("wheel radius", "wheel_radius", r"([\d.]+) m"),
        ("track", "track", r"([\d.]+) m"),
        ("centre of gravity", "centre_of_gravity_ahead", r"([\d.]+) m ahead"),
        ("centre of gravity", "centre_of_gravity_height", r"([\d.]+) m high"),
        ("full lock", "max_steering_angle", r"([\d.]+) rad"),
        ("steering rate", "max_steering_rate", r"([\d.]+) rad/s"),
        ("torque of all wheels", "drive_torque", r"([\d,]+) N m from rest"),
        ("torque of all wheels", "drive_torque_slope", r"less ([\d.]+) N m s/rad"),
        ("throttle without effect", "throttle_dead_band", r"up to ([\d.]+)"),
        ("lag of the pedals", "throttle_lag", r"([\d.]+) s each"),
        ("lag of the pedals", "brake_lag", r"([\d.]+) s each"),
        ("brake torque", "brake_torque", r"([\d,]+) N m"),
        ("front share of it", "brake_front_share", r"([\d.]+)"),
        ("drag area", "drag_area", r"([\d.]+) m2"),
        ("rolling resistance", "rolling_torque", r"([\d.]+) N m a wheel"),
    ],
)
def test_card_of_the_mkz_has_the_numbers_of_its_file(row, field, pattern):
    card = PAGE.partition("## The `mkz`")[2].partition("**Acceleration")[0]
    (cells,) = [cells for cells in rows(card) if cells[0] == row]
    found = re.search(rf"(?<![\d,.]){pattern}", cells[1])
    assert found is not None, cells[1]
    expected = getattr(cars.load("mkz").parameters, field)
    assert float(found[1].replace(",", "")) == pytest.approx(expected, abs=1e-5)


def test_report_is_of_this_car_and_every_bar_holds():
    command = "run: mjdrive car test --car mkz --out docs/car_mkz"
    assert REPORT["car_digest"] == cars.load("mkz").digest, command
    assert [bar["figure"] for bar in REPORT["bars"] if not bar["holds"]] == []


def test_table_of_the_manoeuvres_is_that_report():
    table = PAGE.partition("<!-- measured mkz: begin -->")[2].partition(
        "<!-- measured mkz: end -->"
    )[0]
    shown = [row for row in rows(table) if not row[0].startswith("**")]
    assert [row[0] for row in shown] == [bar["figure"] for bar in REPORT["bars"]]
    for row, bar in zip(shown, REPORT["bars"], strict=True):
        assert row[1] == number(bar["measured"], bar["unit"]), "run: python scripts/car_card.py"
        assert row[3] == bar["reason"], "run: python scripts/car_card.py"
