from pathlib import Path

import pytest

from mjdrive.config import to_json
from mjdrive.errors import ConfigError, TownFormatError
from mjdrive.town.street_plan import CornerPlan, StreetPlan, read_plan

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
