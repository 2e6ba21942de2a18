import pytest

from mjdrive.errors import ConfigError
from mjdrive.town.settings import LightTiming, SceneryConfig, TownSettings


def test_a_turn_is_green_yellow_and_all_red() -> None:
    assert LightTiming(green=8.0, yellow=2.5, all_red=1.5).turn == 12.0


@pytest.mark.parametrize("values", [{"green": -1.0}, {"green": 0.0, "yellow": 0.0, "all_red": 0.0}])
def test_impossible_timings_are_refused(values: dict[str, float]) -> None:
    with pytest.raises(ConfigError, match="expected"):
        LightTiming(**values)


def test_a_range_the_wrong_way_round_is_refused() -> None:
    with pytest.raises(ConfigError, match=r"building_height is 9\.0 to 3\.0 m"):
        SceneryConfig(building_height=(9.0, 3.0))


def test_a_route_of_one_waypoint_is_refused() -> None:
    with pytest.raises(ConfigError, match="Route 'short' has 1 waypoints"):
        TownSettings(routes={"short": ((0.0, 0.0),)})
