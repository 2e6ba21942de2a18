"""A session in the words of the wire; wire.py says what each message holds."""

from typing import Any

import numpy as np
from jaxtyping import Int8

from mjdrive.web import wire
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
    by_hand: bool,
) -> bytes:
    """Say what the policy sees and thinks, and what it would do."""
    simulation, action = session.simulation, decision.action
    vehicle, lights = simulation.vehicle, simulation.lights
    head: dict[str, Any] = {
        "tick": decision.tick,
        "t": round(simulation.time, 3),
        "x": round(vehicle.x, 2),
        "y": round(vehicle.y, 2),
        "yaw": round(vehicle.yaw, 4),
        "speed": round(vehicle.speed, 3),
        "action": action and [round(action.acceleration, 4), round(action.steering, 4)],
        "driven": [round(simulation.action.acceleration, 4), round(simulation.action.steering, 4)],
        "by": "hand" if by_hand else session.mind.name,
    }
    blobs: dict[str, np.ndarray] = {
        "bev": decision.observation.bev,
        "lights": np.array([lights[name] for name in simulation.town.lights], np.uint8),
    }
    if density is not None:
        head |= {"low": round(density.low, 3), "high": round(density.high, 3)}
        blobs["density"] = density.pixels
    if points is not None:
        blobs["points"] = points
    return wire.pack("panel", head, blobs)


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
