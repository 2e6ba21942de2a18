"""A crossing small enough to reckon by hand, and drives along it."""

from collections.abc import Callable

import numpy as np
import pytest

from mjdrive.datatypes import Episode, Infraction, Lane, Move, Signal, Town, TrafficLight


def _lane(id: str, points: list[tuple[float, float]], junction: str | None, move: Move) -> Lane:
    return Lane(id, np.array(points, float), 4.0, (), junction, None, move)


@pytest.fixture
def crossing() -> Town:
    """Eastward road of 100 m; at x = 40 m a junction goes straight on, or left to the north.

    The stop line at x = 40 m is green for 10 s, yellow for 3 s, then red for 32 s.
    """
    left = [(40 + 20 * np.sin(a), 20 - 20 * np.cos(a)) for a in np.linspace(0, np.pi / 2, 9)]
    lanes = [
        _lane("west", [(0, 0), (40, 0)], None, Move.FOLLOW),
        _lane("straight", [(40, 0), (60, 0)], "crossing", Move.STRAIGHT),
        _lane("left", left, "crossing", Move.LEFT),
        _lane("east", [(60, 0), (100, 0)], None, Move.FOLLOW),
    ]
    light = TrafficLight(
        id="light",
        lane="west",
        junction="crossing",
        stop_line=np.array([[40.0, 2.0], [40.0, -2.0]]),
        yaw=0.0,
        pole=np.array([42.0, -4.0]),
        program=((Signal.GREEN, 10.0), (Signal.YELLOW, 3.0), (Signal.RED, 32.0)),
        offset=0.0,
    )
    return Town(
        name="crossing",
        lanes={lane.id: lane for lane in lanes},
        lights={"light": light},
        bounds=np.array([0.0, -2.0, 100.0, 20.0]),
        digest="0" * 64,
    )


@pytest.fixture
def make_drive() -> Callable[..., Episode]:
    def make(
        x: np.ndarray,
        *,
        y: np.ndarray | float = 0.0,
        yaw: np.ndarray | float = 0.0,
        on_lane: np.ndarray | bool = True,
        infractions: tuple[Infraction, ...] = (),
        light_phase: float = 0.0,
    ) -> Episode:
        """A drive through the given positions, 0.1 s apart."""
        x = np.asarray(x, float)
        y, yaw, on_lane = (np.broadcast_to(value, x.shape) for value in (y, yaw, on_lane))
        speed = np.hypot(np.diff(x, prepend=x[:1]), np.diff(y, prepend=y[:1])) / 0.1
        zero = np.zeros_like(x)
        return Episode(
            town="crossing",
            policy="hand",
            seed=7,
            light_phase=light_phase,
            time=0.1 * np.arange(len(x)),
            physics=np.zeros((len(x), 3)),
            vehicle=np.stack([x, y, yaw, speed, zero, zero], axis=1).astype(float),
            actions=np.stack([np.sin(x / 9), np.cos(x / 7)], axis=1),
            labels=np.zeros((len(x), 2)),
            on_lane=on_lane.copy(),
            infractions=infractions,
            metadata={"version.mjdrive": "0.1.0", "settings": "{}"},
        )

    return make
