"""Light poles, and lamps that show what the lights say."""

from collections.abc import Callable, Iterable, Mapping
from itertools import pairwise

import mujoco
import numpy as np

from mjdrive.datatypes import Signal, Town, TrafficLight
from mjdrive.simulation.blocks import DECIMALS, SHOWN_GROUP, UNSEEN_GROUP, add_post, upright
from mjdrive.simulation.meshes import Shell, show_mesh

POLE_RADIUS = 0.07  # [m]
HOUSING = (0.13, 0.19, 0.64)  # half depth, half width, half height of the box around the lamps [m]
BACK_PLATE = (0.02, 0.33, 0.80)  # half sizes of the plate that sets them off from the sky [m]
LAMP_RADIUS = 0.15  # [m]
LAMP_PITCH = 0.41  # vertical distance between lamps [m]
VISOR = (0.175, 0.24)  # radius and length [m]
VISOR_ARC = np.linspace(-0.35, np.pi + 0.35, 8)  # from side to side over the lamp [rad]
HEAD = "traffic_light_head"
LIT = np.array([[0.10, 0.95, 0.35, 1.0], [1.0, 0.78, 0.08, 1.0], [1.0, 0.12, 0.08, 1.0]])
DARK = np.array([[0.04, 0.13, 0.07, 1.0], [0.15, 0.12, 0.04, 1.0], [0.15, 0.05, 0.04, 1.0]])


def add_lights(spec: mujoco.MjSpec, lights: Iterable[TrafficLight], *, height: float) -> None:
    """Stand the poles of lights, each with a head of three lamps that faces its approach.

    Lights of one pole share it, and lights of one signal share their head.

    Args:
        spec: Scene with the materials of `palette`.
        lights: Where they stand and whom they face.
        height: Of the poles [m].
    """
    lights = list(lights)
    if lights:
        head_shell().mesh(spec, HEAD)
    centre = height - HOUSING[2]
    poles, heads = _first_of(lights, _place), _first_of(lights, _facing)
    for light in poles.values():
        x, y = light.pole.tolist()
        add_post(
            spec,
            f"pole_{light.id}",
            x=x,
            y=y,
            radius=POLE_RADIUS,
            height=height,
            material="metal",
        )
    for light in heads.values():
        show_mesh(
            spec,
            f"head_{light.id}",
            mesh=HEAD,
            material="metal",
            position=np.array([*light.pole, centre]),
            quaternion=upright(light.yaw),
        )
    for light in lights:  # apart from the poles, so that the numbers of all lamps are consecutive
        is_seen = heads[_facing(light)] is light
        _add_lamps(spec, light, centre, group=SHOWN_GROUP if is_seen else UNSEEN_GROUP)


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


def head_shell() -> Shell:
    """Build housing, back plate and visors around the origin; x points away from the approaching driver."""
    shell = Shell()
    back = -POLE_RADIUS
    for half_depth, half_width, half_height in (HOUSING, BACK_PLATE):
        near, far = back - 2 * half_depth, back
        outline = [[far, -half_width], [far, half_width], [near, half_width], [near, -half_width]]
        shell.box(np.array(outline), bottom=-half_height, top=half_height, floor=True)
    face = back - 2 * HOUSING[0]
    radius, length = VISOR
    arc = radius * np.stack([np.cos(VISOR_ARC), np.sin(VISOR_ARC)], axis=1)
    for signal in Signal:
        middle = np.array([0.0, (signal - Signal.YELLOW) * LAMP_PITCH])
        for start, end in pairwise(arc + middle):
            plate = np.array(
                [[face, *start], [face, *end], [face - length, *end], [face - length, *start]]
            )
            shell.polygon(plate)
            shell.polygon(plate[::-1])
    return shell


def _place(light: TrafficLight) -> tuple[float, ...]:
    return tuple(light.pole.round(1).tolist())


def _facing(light: TrafficLight) -> tuple[float, ...]:
    return (*_place(light), round(light.yaw, 1))


def _first_of(
    lights: list[TrafficLight], key: Callable[[TrafficLight], tuple[float, ...]]
) -> dict[tuple[float, ...], TrafficLight]:
    """Choose the light that builds what several lights share; a signal over three lanes is three lights."""
    return {key(light): light for light in reversed(lights)}


def _lamp(light_id: str, signal: Signal) -> str:
    return f"lamp_{light_id}_{signal.name.lower()}"


def _add_lamps(spec: mujoco.MjSpec, light: TrafficLight, centre: float, *, group: int) -> None:
    towards_driver = -np.array([np.cos(light.yaw), np.sin(light.yaw)])
    face = light.pole + (POLE_RADIUS + 2 * HOUSING[0] - 0.4 * LAMP_RADIUS) * towards_driver
    for signal in Signal:
        height = centre + (signal - Signal.YELLOW) * LAMP_PITCH
        spec.worldbody.add_geom(
            name=_lamp(light.id, signal),
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[LAMP_RADIUS, 0, 0],
            pos=[*face.round(DECIMALS), round(height, DECIMALS)],
            contype=0,
            conaffinity=0,
            group=group,
            material="lamp",
            rgba=DARK[signal],
        )
