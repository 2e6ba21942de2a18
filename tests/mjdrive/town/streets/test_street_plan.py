from dataclasses import replace
from pathlib import Path

import pytest

from mjdrive.config import to_json
from mjdrive.errors import ConfigError, TownFormatError
from mjdrive.town.streets.street_plan import CornerPlan, SpeedSignPlan, StreetPlan, read_plan

PLAN = """
name = "loop"
[nodes]
10 = [0.0, 0.0]
11 = [50.0, 0.0]
[streets]
1 = ["10", "11"]
[corners.10]
arms = { 1 = 10.0, 2 = 10.0 }
radius = 9.0
[junctions]
"""


def test_a_plan_must_exist(tmp_path: Path) -> None:
    with pytest.raises(TownFormatError, match=r"nowhere\.toml.*Expected TOML"):
        read_plan(tmp_path / "nowhere.toml")


def test_a_plan_must_be_toml(tmp_path: Path) -> None:
    path = tmp_path / "plan.toml"
    path.write_text("name = ")
    with pytest.raises(TownFormatError, match="Expected TOML"):
        read_plan(path)


def test_a_street_must_end_at_known_nodes(tmp_path: Path) -> None:
    path = tmp_path / "plan.toml"
    path.write_text(PLAN)
    with pytest.raises(
        ConfigError, match=r"Street '1' ends at node '11'; expected one of \['10'\]"
    ):
        read_plan(path)


def test_a_corner_joins_two_streets() -> None:
    with pytest.raises(ConfigError, match="expected two"):
        CornerPlan(arms={"1": 10.0}, radius=9.0)


def test_a_plan_can_be_written_down(plan: StreetPlan) -> None:
    assert '"name": "ladder"' in to_json(plan)


def test_ids_are_used_once(plan: StreetPlan) -> None:
    with pytest.raises(ConfigError, match=r"Id '1' is used 2 times; expected whole numbers"):
        replace(plan, corners={**plan.corners, "1": plan.corners["10"]})


@pytest.mark.parametrize("name", ["1000", "main"])
def test_ids_are_numbers_of_three_digits(plan: StreetPlan, name: str) -> None:
    with pytest.raises(ConfigError, match=rf"Id '{name}' .* expected whole numbers from 0 to 999"):
        replace(plan, streets={**plan.streets, name: ("10", "20")})


def test_signals_are_named_once(plan: StreetPlan) -> None:
    light = plan.junctions["20"].lights[0]
    with pytest.raises(ConfigError, match=rf"Signal id '{light.id}' is used 2 times"):
        replace(plan, signs=(SpeedSignPlan(light.id, "1", 30.0, (20.0, -5.0)),))


def test_a_sign_stands_beside_a_street_of_the_plan(plan: StreetPlan) -> None:
    with pytest.raises(ConfigError, match=r"Sign 's' stands beside street '77'; expected one of"):
        replace(plan, signs=(SpeedSignPlan("s", "77", 30.0, (20.0, -5.0)),))
