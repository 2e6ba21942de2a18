"""Messages between server and page, version 1: the one place that says what goes over the socket.

Binary messages, to the page: [u32 n, little endian][JSON head, n bytes][blobs]. Each blob begins at a multiple of 8 bytes; the
head says in "b" where: name -> [dtype, shape, offset from the end of the head]; where a number of bytes follows, so many are the
blob deflated by zlib, for pages behind slow links. Every head has "v", the version, and "k":

    "pose"     50 times a second   t [s], speed [m/s], action [acceleration, steering], seq (of the keys that are driven
               by), rate (simulated over real time); blob q: position [m] and quaternion of each body, (N, 7)
    "panel"    each decision, 20 times a second at most: tick, t, x, y [m], yaw [rad], speed [m/s], action (of the policy;
               null where it has none while a person drives), driven (what is done at this tick; null while it is
               paused), by (who drives); blobs bev: the five channels of the view, (5, S, S) uint8; lights: signal of each
               light; rows: the last steps before this tick, as in "history"; and where the policy can be asked: density:
               log of its density less the highest, over DEPTH nats, acceleration outermost, uint8, with low and high
               [nats] in the head; points: candidates of its sampler by iteration, int8 of 127
    "history"  at the start and after a reset or load; blob rows: t, x, y, speed, and the acceleration and steering that
               were done then, (T, 6)
    "beat"     every five seconds, whatever else is sent: where it stays away, the connection is lost
    "scene"    the town, answered to GET api/scene (see scene.py)

Text messages, to the page: JSON with "v" and "k": "state" (what is chosen, paused, driven and loaded; why the drive stopped:
fault; the number of this page: you, of the pages in control and at the wheel: operator, driver, of those who ask: asking),
"scene" (there is another one) and "note" (a line for people). To the server: JSON commands (see commands.py), at most
MOST_BYTES long.

Every binary message is acknowledged with {"op": "ack", "n": how many have come so far}; a page that acknowledges nothing for
long is closed.
"""

import json
import struct
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np

VERSION = 1
MOST_BYTES = 16_384
"""Of a message to the server [bytes]."""

ALIGNMENT = 8
"""Of blobs, so that the page can look at them in place [bytes]."""

WORTH_DEFLATING = 1024
"""Smaller blobs go as they are [bytes]."""

DEFLATE_LEVEL = 1
"""Of what goes over a slow link: the fastest; a view becomes a tenth already [-]."""


def pack(
    kind: str,
    head: Mapping[str, Any],
    blobs: Mapping[str, np.ndarray] | None = None,
    *,
    level: int = 0,
) -> bytes:
    """Write a binary message.

    Args:
        kind: One of those above.
        head: JSON values.
        blobs: Arrays by name.
        level: How hard large blobs are deflated, 1 to 9; 0 leaves them as they are [-].
    """
    parts: list[bytes] = []
    places: dict[str, list[Any]] = {}
    offset = 0
    for name, array in (blobs or {}).items():
        content = np.ascontiguousarray(array).tobytes()
        places[name] = [array.dtype.name, list(array.shape), offset]
        if level and len(content) > WORTH_DEFLATING:
            content = zlib.compress(content, level)
            places[name].append(len(content))
        padding = -len(content) % ALIGNMENT
        parts += [content, b"\0" * padding]
        offset += len(content) + padding
    text = json.dumps(
        {"v": VERSION, "k": kind, "b": places, **head}, separators=(",", ":")
    ).encode()
    text += b" " * (-(len(text) + 4) % ALIGNMENT)
    return struct.pack("<I", len(text)) + text + b"".join(parts)


def unpack(message: bytes) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Read a binary message, as the page does.

    Returns:
        Its head without the places of blobs, and its blobs.
    """
    (length,) = struct.unpack_from("<I", message)
    head = json.loads(message[4 : 4 + length])
    blobs = {}
    for name, (dtype, shape, offset, *deflated) in head.pop("b").items():
        begin = 4 + length + offset
        if deflated:
            content = zlib.decompress(message[begin : begin + deflated[0]])
            blobs[name] = np.frombuffer(content, dtype).reshape(shape)
        else:
            count = int(np.prod(shape))
            blobs[name] = np.frombuffer(message, dtype, count, begin).reshape(shape)
    return head, blobs


def deflated(message: bytes, *, level: int = DEFLATE_LEVEL) -> bytes:
    """Write a binary message again, for a slow link or a file."""
    head, blobs = unpack(message)
    return pack(head.pop("k"), head, blobs, level=level)


def text(kind: str, values: Mapping[str, Any]) -> str:
    """Write a text message."""
    return json.dumps({"v": VERSION, "k": kind, **values}, separators=(",", ":"))
