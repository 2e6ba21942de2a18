import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from mjdrive.bev import layers
from mjdrive.config import BevConfig
from mjdrive.errors import ConfigError


def test_unpack_undoes_pack():
    rng = np.random.default_rng(0)
    bev = np.empty((5, 8, 8), np.uint8)
    bev[:2] = rng.choice([0, layers.MARKED], (2, 8, 8))
    bev[2:] = rng.choice([0, *layers.LIGHT_VALUES.values()], (3, 8, 8))
    np.testing.assert_array_equal(layers.unpack(layers.pack(bev)), bev)


@given(hnp.arrays(np.uint8, (4, 4), elements=st.integers(0, 255)))
def test_every_byte_is_the_code_of_one_view(code):
    np.testing.assert_array_equal(layers.pack(layers.unpack(code)), code)


def test_light_values_are_those_of_the_papers_code():
    assert sorted(layers.LIGHT_VALUES.values()) == [80, 170, 255]


def test_unpack_undoes_pack_of_binary_lights():
    rng = np.random.default_rng(0)
    bev = rng.choice(np.array([0, 255], np.uint8), (5, 8, 8))
    np.testing.assert_array_equal(layers.unpack(layers.pack(bev)), bev)


def test_extra_channels_do_not_fit_into_a_byte():
    with pytest.raises(ConfigError, match="7 channels"):
        layers.pack(np.zeros((7, 8, 8), np.uint8))


def test_channels_are_named_in_order():
    names = layers.channel_names(BevConfig(extra_layers=("vehicles", "route")))
    assert names == (
        "road", "lane_lines", "lights_oldest", "lights_older", "lights_now", "vehicles", "route",
    )  # fmt: skip
