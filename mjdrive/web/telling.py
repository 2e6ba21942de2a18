"""A session in the words of the wire; wire.py says what each message holds."""

from typing import Any

import numpy as np
from jaxtyping import Int8

from mjdrive.datatypes import Action
from mjdrive.page import wire
from mjdrive.web.policies import Density
from mjdrive.web.session import Decision, Session


def pose_message(session: Session, *, seq: int, rate: float) -> bytes:
    """Say where the car is."""
    simulation = session.simulation
    data, action = simulation.data, simulation.action
    poses = np.hstack([data.xpos[1:], data.xquat[1:]]).astype(np.float32)
    head = {
        "t": round(float(data.time), 3),
        "speed": round(simulation.vehicle.speed, 3),
        "action": [round(action.acceleration, 3), round(action.steering, 3)],
        "seq": seq,
        "rate": round(rate, 2),
    }
    return wire.pack("pose", head, {"q": poses})


def panel_message(
    session: Session,
    decision: Decision,
    density: Density | None,
    points: Int8[np.ndarray, "I N 2"] | None,
    *,
    driven: Action | None,
    by_hand: bool,
) -> bytes:
    """Say what the policy sees and thinks, what it would do and what is done, and the last steps before.

    Args:
        session: What is driven, at the moment of the decision.
        decision: What the policy sees and would do.
        density: Its landscape, if it was asked for.
        points: Candidates of its sampler, if there was one.
        driven: What is done now; None while that is open.
        by_hand: Whether a person drives.
    """
    simulation = session.simulation
    vehicle, lights = simulation.vehicle, simulation.lights
    head: dict[str, Any] = {
        "tick": decision.tick,
        "t": round(simulation.time, 3),
        "x": round(vehicle.x, 2),
        "y": round(vehicle.y, 2),
        "yaw": round(vehicle.yaw, 4),
        "speed": round(vehicle.speed, 3),
        "action": _commands(decision.action),
        "driven": _commands(driven),
        "by": "hand" if by_hand else session.mind.name,
    }
    blobs: dict[str, np.ndarray] = {
        "bev": decision.observation.bev,
        "lights": np.array([lights[name] for name in simulation.town.lights], np.uint8),
        "rows": session.latest_rows.astype(np.float32),
    }
    if density is not None:
        head |= {"low": round(density.low, 3), "high": round(density.high, 3)}
        blobs["density"] = density.pixels
    if points is not None:
        blobs["points"] = points
    return wire.pack("panel", head, blobs)


def _commands(action: Action | None) -> list[float] | None:
    """Acceleration and steering of an action."""
    return None if action is None else [round(action.acceleration, 4), round(action.steering, 4)]


def history_message(session: Session) -> bytes:
    """Tell the drive so far."""
    choice = session.choice
    head = {"town": choice.town, "policy": choice.policy, "seed": choice.seed}
    return wire.pack("history", head, {"rows": session.rows.astype(np.float32)})


def state_values(session: Session, *, is_paused: bool, speed: float, fault: str) -> dict[str, Any]:
    """Say what is chosen, how the drive stands, and why it stopped."""
    choice, recording = session.choice, session.recording
    return {
        "town": choice.town,
        "policy": choice.policy,
        "seed": choice.seed,
        "paused": is_paused,
        "fault": fault,
        "speed": speed,
        "recorded": 0 if recording is None else len(recording),
        "infractions": [
            [it.kind.name.lower(), round(it.time, 1), round(it.x, 1), round(it.y, 1), it.cause]
            for it in session.infractions
        ],
    }
