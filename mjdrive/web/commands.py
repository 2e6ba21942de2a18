"""What a page may ask for: known words with known values, nothing else.

{"op": "ack", "n": 7}                       binary messages that have come so far
{"op": "keys", "down": ["up"], "seq": 3}    what is held down; repeated, or the wheel lets go
{"op": "steer", "acceleration": 0.2, "steering": -0.1, "seq": 3}   the same from a gamepad
{"op": "wheel", "on": true}                 take the wheel, or give it back
{"op": "pause", "on": true}  {"op": "step"}  {"op": "reset"}
{"op": "force", "acceleration": 0.5, "steering": 0.0}   one step with this action, while paused
{"op": "speed", "factor": 2.0}              simulated over real time, LEAST_SPEED to MOST_SPEED
{"op": "load", "town": "town01", "policy": "pid", "seed": 3}   any of the three
{"op": "keep"}                              write what was driven by hand into the data set of human drives
{"op": "drop"}                              forget it
{"op": "control", "on": true}               ask for control, or take the question back; of the page in control: keep it, or hand over
{"op": "watch"}                             tell me all that others know already
{"op": "hidden", "on": true}                nobody looks: only poses, and few of them
{"op": "slow", "on": true}                  the link is slow: send large blobs deflated

`CONTROLS` are obeyed where they come from the page in control alone (see roles.py).
"""

import json
import math
from dataclasses import dataclass, field
from typing import Any

from mjdrive.errors import MjdriveError
from mjdrive.page.wire import MOST_BYTES

LEAST_SPEED, MOST_SPEED = 0.25, 8.0
KEYS = frozenset({"up", "down", "left", "right", "brake"})
MOST_SEED = 2**32 - 1

CONTROLS = frozenset({"wheel", "pause", "step", "reset", "force", "speed", "load", "keep", "drop"})
"""What changes the drive for all who watch."""

_FIELDS: dict[str, dict[str, type]] = {
    "ack": {"n": int},
    "keys": {"down": list, "seq": int},
    "steer": {"acceleration": float, "steering": float, "seq": int},
    "wheel": {"on": bool},
    "pause": {"on": bool},
    "step": {},
    "reset": {},
    "force": {"acceleration": float, "steering": float},
    "speed": {"factor": float},
    "load": {"town": str, "policy": str, "seed": int},
    "keep": {},
    "drop": {},
    "control": {"on": bool},
    "watch": {},
    "hidden": {"on": bool},
    "slow": {"on": bool},
}


class CommandError(MjdriveError):
    """A message of a page that means nothing here."""


@dataclass(frozen=True, slots=True)
class Command:
    """What a page asks for.

    Attributes:
        op: One of the words above.
        values: What belongs to it, checked.
    """

    op: str
    values: dict[str, Any] = field(default_factory=dict)


def parse(message: str) -> Command:
    """Read a message of a page.

    Raises:
        CommandError: If it is too long, no JSON object, or says anything that is not expected.
    """
    if len(message.encode()) > MOST_BYTES:
        raise CommandError(f"The message is longer than {MOST_BYTES} bytes; expected a short one.")
    try:
        values = json.loads(message)
    except ValueError as error:
        raise CommandError(f"The message is no JSON ({error}); expected a command.") from error
    if not isinstance(values, dict) or values.get("op") not in _FIELDS:
        raise CommandError(f"Expected an object whose 'op' is one of: {', '.join(_FIELDS)}.")
    op = values.pop("op")
    fields = _FIELDS[op]
    unknown = sorted(set(values) - set(fields))
    missing = [] if op == "load" else sorted(set(fields) - set(values))
    if unknown or missing:
        raise CommandError(
            f"'{op}' came with {', '.join(sorted(values)) or 'nothing'}; expected {', '.join(fields) or 'nothing'}."
        )
    return Command(op, {name: _checked(op, name, value) for name, value in values.items()})


def _checked(op: str, name: str, value: Any) -> Any:
    """One value, of its type and within its range."""
    kind = _FIELDS[op][name]
    if kind is float and type(value) in (int, float) and math.isfinite(value):
        low, high = (LEAST_SPEED, MOST_SPEED) if name == "factor" else (-1.0, 1.0)
        return min(max(float(value), low), high)
    if kind is int and type(value) is int and 0 <= value <= MOST_SEED:
        return value
    if kind is list and type(value) is list and set(map(str, value)) <= KEYS:
        return frozenset(value)
    if kind in (bool, str) and type(value) is kind:
        return value
    raise CommandError(f"'{op}' came with {name} = {str(value)[:40]!r}; expected {kind.__name__}.")
