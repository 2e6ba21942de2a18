"""docs/car.md says what the car is and what was measured."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from mjdrive.manoeuvres.rig import Rig
from mjdrive.vehicle import cars

ROOT = Path(__file__).resolve().parents[2]
CARD = (ROOT / "docs/car.md").read_text()
REPORT = json.loads((ROOT / "docs/car/report.json").read_text())
LARGEST_PICTURE = 150_000  # [bytes]


def cells(row: str) -> str:
    """Value and reason of a row of the card."""
    found = re.findall(rf"^\| {re.escape(row)} \| (.*)$", CARD, flags=re.MULTILINE)
    assert len(found) == 1, f"{len(found)} rows '{row}'"
    return found[0]


@pytest.fixture
def card_tables(load_script: Callable[[str], ModuleType]) -> ModuleType:
    return load_script("car_card")


@pytest.mark.parametrize(
    ("row", "field", "pattern"),
    [
        ("mass", "mass", r"([\d,]+) kg"),
        ("wheelbase", "wheelbase", r"([\d.]+) m"),
        ("track", "track", r"([\d.]+) m"),
        ("length", "length", r"([\d.]+) m"),
        ("width", "width", r"([\d.]+) m"),
        ("rear overhang", "rear_overhang", r"([\d.]+) m"),
        ("rear overhang", "front_overhang", r"front overhang ([\d.]+) m"),
        ("centre of gravity", "centre_of_gravity_ahead", r"([\d.]+) m ahead"),
        ("centre of gravity", "centre_of_gravity_height", r"([\d.]+) m high"),
        ("wheel radius", "wheel_radius", r"([\d.]+) m"),
        ("wheel inertia", "wheel_inertia", r"([\d.]+) kg m2"),
        ("full lock", "max_steering_angle", r"([\d.]+) rad"),
        ("steering rate", "max_steering_rate", r"([\d.]+) rad/s"),
        ("drive torque", "drive_torque", r"([\d,]+) N m"),
        ("drive torque", "drive_torque_slope", r"less ([\d.]+) N m s/rad"),
        ("throttle lag", "throttle_lag", r"([\d.]+) s"),
        ("brake torque", "brake_torque", r"([\d,]+) N m"),
        ("brake front share", "brake_front_share", r"([\d.]+)"),
        ("brake lag", "brake_lag", r"([\d.]+) s"),
        ("rolling resistance", "rolling_torque", r"([\d.]+) N m a wheel"),
        ("drag area", "drag_area", r"([\d.]+) m2"),
    ],
)
def test_card_has_the_numbers_of_the_car(row, field, pattern):
    (text,) = re.findall(pattern, cells(row))[:1]
    shown = float(text.replace(",", ""))
    decimals = len(text.partition(".")[2])
    assert shown == round(getattr(cars.load().parameters, field), decimals)


def test_card_has_the_tyres_of_the_car():
    car = cars.load().parameters
    front, rear = re.findall(r"(\d+) and (\d+) kN/rad", cells("tyres"))[0]
    assert float(front) * 1000 == car.cornering_stiffness_front
    assert float(rear) * 1000 == car.cornering_stiffness_rear
    spring, damper = re.findall(r"(\d+) kN/m, (\d+) N s/m", cells("tyre spring, damper"))[0]
    assert float(spring) * 1000 == car.tyre_vertical_stiffness
    assert float(damper) == car.tyre_vertical_damping


def test_card_has_the_springs_and_inertias_of_the_car():
    model = Rig.of_car().model
    front, rear = re.findall(r"(\d+) and (\d+) kN/m", cells("springs"))[0]
    for axle, text in (("f", front), ("r", rear)):
        assert float(text) * 1000 == model.joint(f"susp_{axle}l").stiffness[0]
    front, rear = re.findall(r"(\d+) and (\d+) kN/m", cells("anti-roll bars"))[0]
    for axle, text in (("front", front), ("rear", rear)):
        assert float(text) * 1000 == model.tendon_stiffness[model.tendon(f"anti_roll_{axle}").id]
    assert float(cells("dampers").partition(" ")[0]) * 1000 == model.joint("susp_fl").damping[0]
    whole, *body = re.findall(r"[\d,]+\d", cells("yaw inertia"))
    assert float(whole.replace(",", "")) == round(Rig.of_car().single_track.yaw_inertia)
    assert [float(text.replace(",", "")) for text in body] == model.body("car").inertia.tolist()


def test_tables_are_those_that_were_measured(card_tables):
    assert card_tables.with_tables(CARD) == CARD, "run: python scripts/car_card.py"


def test_report_is_of_this_car_and_every_bar_holds():
    assert REPORT["car_digest"] == cars.load().digest, "run: mjdrive car test --plot --out docs/car"
    assert [bar["figure"] for bar in REPORT["bars"] if not bar["holds"]] == []
    assert "is not met" not in CARD


def test_pictures_of_the_card_are_there_and_small():
    pictures = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", CARD)
    assert len(pictures) == 7
    for picture in pictures:
        assert 0 < (ROOT / "docs" / picture).stat().st_size < LARGEST_PICTURE
