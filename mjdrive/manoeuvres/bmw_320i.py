"""Our car with the geometry, masses, springs and tyres of CommonRoad's BMW 320i, to compare the laws of motion alone."""

from typing import Any

import mujoco
import numpy as np

from mjdrive.manoeuvres import multi_body
from mjdrive.manoeuvres.rig import GRAVITY, TIMESTEP, Rig
from mjdrive.manoeuvres.single_track import SingleTrack
from mjdrive.vehicle.assembly import WHEELS, car_on_road

RACK_MASS = 2.0  # which car.xml has beside sprung mass, knuckles and wheels [kg]


def rig(timestep: float = TIMESTEP) -> Rig:
    """Put the BMW with our tyre law, suspension and steering onto the plane.

    Args:
        timestep: Of the physics [s].

    Raises:
        MissingPackageError: If the package that has its numbers is not installed.
    """
    bmw = multi_body.bmw_320i()
    spec = car_on_road(timestep=timestep, friction=bmw.tire.p_dy1)
    _set_tyres(spec, bmw)
    _set_body(spec, bmw)
    for wheel in WHEELS:
        _set_corner(spec, bmw, wheel)
    _set_anti_roll_bars(spec, bmw)
    _set_steering(spec, bmw)
    # The package gives the yaw inertia of the whole car: wheels and knuckles have what the body has not.
    body = spec.body("car")
    body.inertia[2] += bmw.I_z - SingleTrack.of(spec.compile()).yaw_inertia
    return Rig(spec.compile())


def _set_tyres(spec: mujoco.MjSpec, bmw: Any) -> None:
    spec.numeric("cornering_stiffness").data = np.array(multi_body.cornering_stiffness(bmw))
    spec.numeric("tyre_vertical_stiffness").data = np.array([bmw.K_zt])
    for wheel in WHEELS:
        tyre = spec.geom(f"tyre_{wheel}")
        tyre.size = [bmw.R_w, tyre.size[1], bmw.R_w]


def _set_body(spec: mujoco.MjSpec, bmw: Any) -> None:
    body, wheelbase = spec.body("car"), bmw.a + bmw.b
    ahead = (bmw.m * bmw.b - bmw.m_uf * wheelbase) / bmw.m_s
    body.mass = bmw.m_s - RACK_MASS
    body.ipos = [ahead, 0.0, bmw.h_s]
    body.inertia = [bmw.I_Phi_s, bmw.I_y_s, bmw.I_y_s]  # the last one until the wheels are on
    spec.body("rack").pos = [ahead, 0.0, bmw.h_s]


def _set_corner(spec: mujoco.MjSpec, bmw: Any, wheel: str) -> None:
    """Place a wheel and give it its mass, spring and damper."""
    wheelbase = bmw.a + bmw.b
    if wheel.startswith("f"):
        x, track, mass, lever = wheelbase, bmw.T_f, bmw.m_uf, bmw.b
        stiffness, damping = bmw.K_sf, bmw.K_sdf
    else:
        x, track, mass, lever = 0.0, bmw.T_r, bmw.m_ur, bmw.a
        stiffness, damping = bmw.K_sr, bmw.K_sdr
    side = 0.5 if wheel.endswith("l") else -0.5
    knuckle, body = spec.body(f"knuckle_{wheel}"), spec.body(f"wheel_{wheel}")
    knuckle.pos = [x, side * track, bmw.R_w]
    knuckle.mass = body.mass = 0.25 * mass
    body.inertia = [0.5 * bmw.I_y_w, bmw.I_y_w, 0.5 * bmw.I_y_w]
    joint = spec.joint(f"susp_{wheel}")
    load = 0.5 * bmw.m_s * GRAVITY * lever / wheelbase
    joint.stiffness = np.array([stiffness, *joint.stiffness[1:]])
    joint.damping = np.array([damping, *joint.damping[1:]])
    joint.springref = -load / stiffness
    joint.range = [-0.2, 0.2]


def _set_anti_roll_bars(spec: mujoco.MjSpec, bmw: Any) -> None:
    """The package has a roll stiffness [N m/rad] an axle; ours is per difference of wheel travel [N/m]."""
    for axle, torsion, track in (("front", bmw.K_tsf, bmw.T_f), ("rear", bmw.K_tsr, bmw.T_r)):
        tendon = spec.tendon(f"anti_roll_{axle}")
        tendon.stiffness = np.array([-torsion / track**2, *tendon.stiffness[1:]])


def _set_steering(spec: mujoco.MjSpec, bmw: Any) -> None:
    """The front wheels of the model are parallel, and turn slower and further than ours."""
    lock = bmw.steering.max
    spec.joint("steer").range = [-lock, lock]
    steering = spec.actuator("steering")
    steering.gear[0] = 1.0 / lock
    steering.dynprm[1] = bmw.steering.v_max / lock
    for equality in spec.equalities:
        if equality.name2 == "steer":
            equality.data[:5] = [0.0, 1.0, 0.0, 0.0, 0.0]
