"""Messages survive the wire, and their arrays can be looked at in place."""

import json
import struct

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.page import wire


@given(st.integers(0, 9), st.integers(0, 5), st.text(max_size=20))
def test_unpacking_undoes_packing(rows: int, columns: int, name: str) -> None:
    blobs = {
        "a": np.arange(rows * columns, dtype=np.float32).reshape(rows, columns),
        "b": np.arange(rows, dtype=np.uint8),
        "c": np.arange(columns, dtype=np.int8),
    }
    head, found = wire.unpack(wire.pack("pose", {"name": name}, blobs))
    assert head == {"v": wire.VERSION, "k": "pose", "name": name}
    assert {key: it.dtype for key, it in found.items()} == {
        key: it.dtype for key, it in blobs.items()
    }
    for key, blob in blobs.items():
        np.testing.assert_array_equal(found[key], blob)


@given(st.text(max_size=30), st.integers(0, 20))
def test_every_blob_begins_where_the_page_can_look_at_it_in_place(name: str, size: int) -> None:
    blobs = {"a": np.zeros(size, np.uint8), "b": np.zeros(size, np.float32)}
    message = wire.pack("panel", {"name": name}, blobs)
    (length,) = struct.unpack_from("<I", message)
    places = json.loads(message[4 : 4 + length])["b"]
    assert (4 + length) % wire.ALIGNMENT == 0
    assert all(offset % wire.ALIGNMENT == 0 for _, _, offset in places.values())


def test_a_deflated_view_is_the_same_view_in_a_tenth_of_the_bytes() -> None:
    bev = np.zeros((5, 192, 192), np.uint8)
    bev[0, 40:160, 80:110] = 255
    lights = np.arange(3, dtype=np.uint8)
    message = wire.pack("panel", {"tick": 7}, {"bev": bev, "lights": lights})
    small = wire.deflated(message)
    head, blobs = wire.unpack(small)
    assert head == {"v": wire.VERSION, "k": "panel", "tick": 7}
    np.testing.assert_array_equal(blobs["bev"], bev)
    np.testing.assert_array_equal(blobs["lights"], lights)
    assert 10 * len(small) < len(message)
