import numpy as np
import pytest
import shapely

from mjdrive.bev.projector import BevProjector
from mjdrive.config import BevConfig, from_dict
from mjdrive.datatypes import Town
from mjdrive.errors import ConfigError
from mjdrive.town import library
from mjdrive.town.scenery import Scenery, lay_out
from mjdrive.town.scenery.blocks import Block

POSE = {"x": 0.0, "y": -2.0, "yaw": 0.0, "time": 0.0, "light_phase": 0.0}
ALL = ("route", "sidewalks", "buildings", "vehicles")
CAR = Block(x=10.0, y=-2.0, yaw=0.0, length=4.5, depth=1.8, height=1.5)


@pytest.fixture
def scenery() -> Scenery:
    """Sidewalks from 4 to 7 m beside the street, one house to its left."""
    return Scenery(
        road=shapely.box(-100, -4, 100, 4),
        sidewalk=shapely.union_all([shapely.box(-100, 4, 100, 7), shapely.box(-100, -7, 100, -4)]),
        verge=shapely.Polygon(),
        buildings=(Block(x=12.0, y=12.0, yaw=0.0, length=10.0, depth=6.0, height=8.0),),
        trees=(),
    )


def drawn(town: Town, layers: tuple[str, ...], scenery: Scenery | None = None, **frame: object):
    projector = BevProjector(town, config=BevConfig(extra_layers=layers), scenery=scenery)
    return projector.project(**POSE, **frame)


def centre_and_size(channel: np.ndarray) -> np.ndarray:
    """Middle ahead and to the left of the ego point and size along and across [m]."""
    rows, columns = np.nonzero(channel)
    middle = [152 - 0.5 * (rows.min() + rows.max()), 96 - 0.5 * (columns.min() + columns.max())]
    return np.array([*middle, np.ptp(rows) + 1, np.ptp(columns) + 1]) / 5


def test_five_channels_are_the_default_and_stay_the_same_under_extra_ones(make_street, scenery):
    route = np.array([[0.0, -2.0], [50.0, -2.0]])
    five = drawn(make_street(), ())
    assert len(five) == 5
    nine = drawn(make_street(), ALL, scenery, route=route, vehicles=[CAR])
    np.testing.assert_array_equal(nine[:5], five)


@pytest.mark.parametrize("layers", [ALL, ALL[::-1]])
def test_extra_channels_come_in_the_order_asked_for(make_street, scenery, layers):
    projector = BevProjector(make_street(), config=BevConfig(extra_layers=layers), scenery=scenery)
    assert projector.channels[5:] == layers
    bev = projector.project(**POSE, route=np.array([[0.0, -2.0], [50.0, -2.0]]), vehicles=[CAR])
    areas = {name: np.count_nonzero(bev[5 + place]) / 25 for place, name in enumerate(layers)}
    assert areas["vehicles"] == pytest.approx(4.5 * 1.8, rel=0.2)
    assert areas["buildings"] == pytest.approx(10 * 6, rel=0.12)  # with the pixels it touches
    assert areas["sidewalks"] == pytest.approx(2 * 3 * 38.4, rel=0.15)
    assert areas["route"] == pytest.approx(3.2 * (30.4 + 1.35), rel=0.15)
    assert set(np.unique(bev[5:])) == {0, 255}


def test_house_and_car_stand_where_they_are(make_street, scenery):
    house, car = drawn(make_street(), ("buildings", "vehicles"), scenery, vehicles=[CAR])[5:]
    np.testing.assert_allclose(centre_and_size(house), [12 - 1.35, 14, 10, 6], atol=0.5)
    np.testing.assert_allclose(centre_and_size(car), [10 - 1.35, 0, 4.5, 1.8], atol=0.25)


def test_cars_turn_with_their_yaw(make_street):
    across = Block(x=10.0, y=-2.0, yaw=np.pi / 2, length=4.5, depth=1.8, height=1.5)
    (car,) = drawn(make_street(), ("vehicles",), vehicles=[across])[5:]
    np.testing.assert_allclose(centre_and_size(car)[2:], [1.8, 4.5], atol=0.25)


def test_road_without_other_cars_has_an_empty_channel(make_street):
    assert not drawn(make_street(), ("vehicles",))[5].any()


@pytest.mark.parametrize("layer", ["sidewalks", "buildings"])
def test_scenery_is_asked_for(make_street, layer):
    with pytest.raises(ConfigError, match=r"no scenery was given.*lay_out"):
        BevProjector(make_street(), config=BevConfig(extra_layers=(layer,)))


def test_route_is_given_exactly_where_it_is_drawn(make_street):
    with pytest.raises(ConfigError, match="without a route"):
        drawn(make_street(), ("route",))
    with pytest.raises(ConfigError, match="with a route"):
        drawn(make_street(), (), route=np.zeros((2, 2)))


def test_vehicles_without_a_channel_are_refused(make_street):
    with pytest.raises(ConfigError, match="add 'vehicles'"):
        drawn(make_street(), (), vehicles=[CAR])


@pytest.mark.parametrize("layers", [["trees"], ["route", "route"]])
def test_layers_unknown_or_named_twice_are_refused(layers):
    with pytest.raises(ConfigError, match="extra_layers"):
        from_dict(BevConfig, {"extra_layers": layers})


def test_scenery_of_a_town_leaves_its_road_free(town02):
    scenery = lay_out(town02, library.load_settings("town02").scenery)
    projector = BevProjector(
        town02,
        config=BevConfig(extra_layers=("sidewalks", "buildings"), road_outline_px=1),
        scenery=scenery,
    )
    points = np.concatenate([lane.centerline for lane in town02.lanes.values()])
    seen = np.zeros(2, int)
    for x, y in np.random.default_rng(0).choice(points, 20):
        bev = projector.project(x=x, y=y, yaw=0.3, time=0.0, light_phase=0.0) > 0
        assert not (bev[0] & bev[6]).any()
        assert np.count_nonzero(bev[0] & bev[5]) < 0.02 * np.count_nonzero(bev[0])
        seen += bev[5:].any(axis=(1, 2))
    assert np.all(seen >= 15)
