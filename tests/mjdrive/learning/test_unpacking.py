import numpy as np
import torch

from mjdrive.bev import layers
from mjdrive.learning.unpacking import pair_table, unpack


def test_every_code_is_unpacked_as_the_layers_do() -> None:
    rng = np.random.default_rng(0)
    codes = rng.integers(0, 256, (3, 192, 192), dtype=np.uint8)
    codes[0].flat[:512] = np.arange(512) % 256
    found = unpack(torch.from_numpy(codes), pair_table())
    np.testing.assert_array_equal(found, layers.unpack(codes))
    assert found.is_contiguous(memory_format=torch.channels_last)
