"""Sky, sun and camera settings: what only pictures depend on."""

import mujoco
import numpy as np

from mjdrive.datatypes import Town
from mjdrive.simulation.blocks import DECIMALS

EXTENT = 100.0  # unit of clipping planes, shadows and haze [m]
# MuJoCo lays the axes of its shadow map along the slope of the ground if the sun stands over 30 degrees off the x axis
# (rays with |y| > 0.5); otherwise ground speckles far from the car, towards the sun.
SUN = np.array([0.41, 0.56, -0.72])  # direction of its rays [-]
SUN_DISTANCE = 150.0  # [m]
SKY = ((0.50, 0.68, 0.88), (0.90, 0.94, 0.96))  # above, at the horizon


def set_stage(spec: mujoco.MjSpec, town: Town) -> None:
    """Set sky, sun and everything else that only pictures depend on.

    Args:
        spec: Scene to add to; it has a body "car", which the sun follows to throw sharp shadows around it.
        town: Road network, to look at its middle.
    """
    left, bottom, right, top = town.bounds.round(DECIMALS - 1).tolist()
    spec.stat.center = [0.5 * (left + right), 0.5 * (bottom + top), 0.0]
    spec.stat.extent = EXTENT
    spec.visual.map.znear = 0.002
    spec.visual.map.zfar = 30.0
    spec.visual.map.shadowclip = 0.55
    spec.visual.map.haze = 0.25
    spec.visual.quality.shadowsize = 4096
    spec.visual.quality.offsamples = 4
    spec.visual.global_.offwidth, spec.visual.global_.offheight = 1920, 1080
    spec.visual.rgba.haze = [*SKY[1], 1.0]
    spec.visual.headlight.ambient = [0.44, 0.45, 0.48]
    spec.visual.headlight.diffuse = [0.10, 0.10, 0.10]
    spec.visual.headlight.specular = [0.0, 0.0, 0.0]
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=SKY[0],
        rgb2=SKY[1],
        width=128,
        height=768,
    )
    spec.body("car").add_light(
        name="sun",
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        mode=mujoco.mjtCamLight.mjCAMLIGHT_TRACK,
        pos=-SUN_DISTANCE * SUN,
        dir=SUN,
        diffuse=[0.60, 0.58, 0.53],
        specular=[0.1, 0.1, 0.1],
        castshadow=True,
    )
