"""Messages as Foxglove and Lichtblick know them, in JSON, with the parts of their schemas that are used here.

Source: https://docs.foxglove.dev/docs/sdk/schemas. Names and fields are theirs.
"""

import math
from typing import Any

import numpy as np

_TIME = {"type": "object", "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}}
_NUMBER, _TEXT = {"type": "number"}, {"type": "string"}
_VECTOR = {"type": "object", "properties": {"x": _NUMBER, "y": _NUMBER, "z": _NUMBER}}
_TURN = {"type": "object", "properties": {**_VECTOR["properties"], "w": _NUMBER}}  # type: ignore[dict-item]
_POSE = {"type": "object", "properties": {"position": _VECTOR, "orientation": _TURN}}
_COLOUR = {"type": "object", "properties": dict.fromkeys("rgba", _NUMBER)}
_LINE = {
    "type": "object",
    "properties": {
        "type": {"type": "integer"},
        "pose": _POSE,
        "thickness": _NUMBER,
        "scale_invariant": {"type": "boolean"},
        "points": {"type": "array", "items": _VECTOR},
        "color": _COLOUR,
    },
}
_ENTITY = {
    "type": "object",
    "properties": {
        "timestamp": _TIME,
        "frame_id": _TEXT,
        "id": _TEXT,
        "lines": {"type": "array", "items": _LINE},
    },
}

SCHEMAS: dict[str, dict[str, Any]] = {
    "foxglove.FrameTransform": {
        "timestamp": _TIME,
        "parent_frame_id": _TEXT,
        "child_frame_id": _TEXT,
        "translation": _VECTOR,
        "rotation": _TURN,
    },
    "foxglove.CompressedImage": {
        "timestamp": _TIME,
        "frame_id": _TEXT,
        "data": {"type": "string", "contentEncoding": "base64"},
        "format": _TEXT,
    },
    "foxglove.Log": {
        "timestamp": _TIME,
        "level": {"type": "integer"},
        "message": _TEXT,
        "name": _TEXT,
        "file": _TEXT,
        "line": {"type": "integer"},
    },
    "foxglove.SceneUpdate": {
        "deletions": {"type": "array", "items": {"type": "object"}},
        "entities": {"type": "array", "items": _ENTITY},
    },
}
"""Properties of each kind of message."""

_ERROR = 4  # level of a log message
_STRIP = 0  # points of a line are joined one after the other
_HERE = {
    "position": {"x": 0.0, "y": 0.0, "z": 0.0},
    "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0},
}


def stamp(time: float) -> dict[str, int]:
    """A time [s] as seconds and nanoseconds."""
    nanoseconds = round(time * 1e9)
    return {"sec": nanoseconds // 10**9, "nsec": nanoseconds % 10**9}


def transform(time: float, *, x: float, y: float, yaw: float) -> dict[str, Any]:
    """Where the car is in the world."""
    return {
        "timestamp": stamp(time),
        "parent_frame_id": "world",
        "child_frame_id": "car",
        "translation": {"x": x, "y": y, "z": 0.0},
        "rotation": {"x": 0.0, "y": 0.0, "z": math.sin(yaw / 2), "w": math.cos(yaw / 2)},
    }


def image(time: float, png: str) -> dict[str, Any]:
    """A PNG picture, in base64."""
    return {"timestamp": stamp(time), "frame_id": "car", "data": png, "format": "png"}


def log(time: float, message: str) -> dict[str, Any]:
    """A line about something that went wrong."""
    said = {"timestamp": stamp(time), "level": _ERROR, "message": message}
    return {**said, "name": "rules", "file": "", "line": 0}


def lines(time: float, name: str, paths: list[np.ndarray]) -> dict[str, Any]:
    """Lines on the ground, world frame [m]."""
    drawn = [
        {
            "type": _STRIP,
            "pose": _HERE,
            "thickness": 1.0,
            "scale_invariant": True,
            "points": [{"x": x, "y": y, "z": 0.0} for x, y in np.round(path, 2).tolist()],
            "color": {"r": 0.55, "g": 0.58, "b": 0.62, "a": 1.0},
        }
        for path in paths
    ]
    entity = {"timestamp": stamp(time), "frame_id": "world", "id": name, "lines": drawn}
    return {"deletions": [], "entities": [entity]}
