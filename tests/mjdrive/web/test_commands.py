"""Pages may say known words with known values, and nothing else."""

import json

import pytest

from mjdrive.page.wire import MOST_BYTES
from mjdrive.web.commands import LEAST_SPEED, MOST_SPEED, CommandError, parse


def test_a_known_command_is_read() -> None:
    command = parse('{"op": "keys", "down": ["up", "left"], "seq": 3}')
    assert command.op == "keys"
    assert command.values == {"down": frozenset({"up", "left"}), "seq": 3}


@pytest.mark.parametrize(
    "message",
    [
        "no JSON",
        "[]",
        '"step"',
        "{}",
        '{"op": "shutdown"}',
        '{"op": "__init__"}',
        '{"op": "step", "count": 5}',
        '{"op": "pause"}',
        '{"op": "pause", "on": 1}',
        '{"op": "ack", "n": -1}',
        '{"op": "ack", "n": true}',
        '{"op": "ack", "n": 1e3}',
        '{"op": "keys", "down": ["up", "escape"], "seq": 1}',
        '{"op": "keys", "down": [["up"]], "seq": 1}',
        '{"op": "force", "acceleration": NaN, "steering": 0}',
        '{"op": "load", "seed": 4294967296}',
        '{"op": "load", "town": 3}',
    ],
)
def test_whatever_else_is_said_is_refused(message: str) -> None:
    with pytest.raises(CommandError, match=r"[Ee]xpected"):
        parse(message)


def test_a_long_message_is_refused_unread() -> None:
    with pytest.raises(CommandError, match="longer"):
        parse(json.dumps({"op": "load", "town": "x" * MOST_BYTES}))


def test_numbers_beyond_their_range_count_as_the_nearest_limit() -> None:
    assert parse('{"op": "speed", "factor": 100}').values["factor"] == MOST_SPEED
    assert parse('{"op": "speed", "factor": 0}').values["factor"] == LEAST_SPEED
    forced = parse('{"op": "force", "acceleration": 7, "steering": -7}').values
    assert forced == {"acceleration": 1.0, "steering": -1.0}
