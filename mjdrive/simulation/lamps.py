"""Light poles, and lamps that show what the lights say."""

from collections.abc import Iterable, Mapping

import mujoco
import numpy as np

from mjdrive.datatypes import Signal, Town, TrafficLight
from mjdrive.simulation.blocks import DECIMALS, SHOWN_GROUP, upright
from mjdrive.vehicle.assembly import OBSTACLE_BITS

POLE_RADIUS = 0.08  # [m]
HEAD_SIZE = (0.14, 0.24, 0.66)  # half depth, half width, half height [m]
LAMP_RADIUS = 0.17  # [m]
LAMP_PITCH = 0.42  # vertical distance between lamps [m]
POLE_RGBA = (0.22, 0.23, 0.25, 1.0)
LIT = np.array([[0.10, 0.95, 0.35, 1.0], [1.0, 0.78, 0.08, 1.0], [1.0, 0.12, 0.08, 1.0]])
DARK = np.array([[0.04, 0.13, 0.07, 1.0], [0.15, 0.12, 0.04, 1.0], [0.15, 0.05, 0.04, 1.0]])


def add_lights(spec: mujoco.MjSpec, lights: Iterable[TrafficLight], *, height: float) -> None:
    """Stand the poles of lights, each with a head of three lamps that faces its approach.

    Args:
        spec: Scene to add to; it has a material "lamp".
        lights: Where they stand and whom they face.
        height: Of the poles [m].
    """
    lights = list(lights)
    for light in lights:
        _add_pole(spec, light, height)
        _add_head(spec, light, height - HEAD_SIZE[2])
    for light in lights:  # apart from the poles, so that the numbers of all lamps are consecutive
        _add_lamps(spec, light, height - HEAD_SIZE[2])


def set_lamps(model: mujoco.MjModel, town: Town, signals: Mapping[str, Signal]) -> None:
    """Light one lamp of every light and darken the others; the physics does not notice.

    Args:
        model: Compiled scene of the town.
        town: Road network.
        signals: What every light of the town shows, by name.
    """
    if not town.lights:
        return
    # The scene adds the lamps of all lights in one go, so their numbers are consecutive.
    first = model.geom(_lamp(next(iter(town.lights)), Signal.GREEN)).id
    lamps = slice(first, first + len(Signal) * len(town.lights))
    shown = np.array([signals[light] for light in town.lights])
    is_lit = shown[:, None] == np.arange(len(Signal))
    model.geom_rgba[lamps] = np.where(is_lit[..., None], LIT, DARK).reshape(-1, 4)


def _lamp(light_id: str, signal: Signal) -> str:
    return f"lamp_{light_id}_{signal.name.lower()}"


def _ahead_of_pole(light: TrafficLight, distance: float) -> list[float]:
    """Point that lies off the pole towards the approaching driver."""
    facing = -np.array([np.cos(light.yaw), np.sin(light.yaw)])
    return (light.pole + distance * facing).round(DECIMALS).tolist()


def _add_pole(spec: mujoco.MjSpec, light: TrafficLight, height: float) -> None:
    contype, conaffinity = OBSTACLE_BITS
    spec.worldbody.add_geom(
        name=f"pole_{light.id}",
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[POLE_RADIUS, 0.5 * height, 0],
        pos=[*_ahead_of_pole(light, 0.0), 0.5 * height],
        contype=contype,
        conaffinity=conaffinity,
        rgba=POLE_RGBA,
    )


def _add_head(spec: mujoco.MjSpec, light: TrafficLight, centre: float) -> None:
    spec.worldbody.add_geom(
        name=f"head_{light.id}",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=HEAD_SIZE,
        pos=[*_ahead_of_pole(light, POLE_RADIUS + HEAD_SIZE[0]), centre],
        quat=upright(light.yaw),
        contype=0,
        conaffinity=0,
        group=SHOWN_GROUP,
        rgba=POLE_RGBA,
    )


def _add_lamps(spec: mujoco.MjSpec, light: TrafficLight, centre: float) -> None:
    for signal in Signal:
        height = centre + (signal - Signal.YELLOW) * LAMP_PITCH
        spec.worldbody.add_geom(
            name=_lamp(light.id, signal),
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[LAMP_RADIUS, 0, 0],
            pos=[*_ahead_of_pole(light, POLE_RADIUS + 2 * HEAD_SIZE[0]), round(height, DECIMALS)],
            contype=0,
            conaffinity=0,
            group=SHOWN_GROUP,
            material="lamp",
            rgba=DARK[signal],
        )
