"""Pedals, steering, locks and numbers of a car file: what would break the physics without a word."""

from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np

from mjdrive.vehicle.assembly import WHEELS
from mjdrive.vehicle.car_shape_checks import numbers

TOLERANCE = 1e-3  # of ratios and angles [-, rad]
MAX_STEERING_ANGLE = 1.4  # [rad]; beyond it the single-track models end
RANGES = {
    "cornering_stiffness": (2, 1e3, 1e6),
    "tyre_vertical_stiffness": (1, 1e4, 1e7),
    "tyre_vertical_damping": (1, 1.0, 1e5),
    "brake_torque": (1, 100.0, 1e5),
    "brake_front_share": (1, 0.0, 1.0),
    "drag_area": (1, 0.0, 10.0),
}
"""How many numbers each numeric holds and their range, which tells kilonewtons and square feet from SI units."""


def control_faults(model: mujoco.MjModel) -> Iterator[str]:
    """Name every fault in how a car is driven.

    Args:
        model: The car on a plane, with every name of `car_parts.PARTS`.

    Yields:
        What was found and what was expected, one clause each.
    """
    for name, low in (("throttle", 0.0), ("brake", 0.0), ("steering", -1.0)):
        actuator = model.actuator(name)
        if not actuator.ctrllimited[0] or not np.array_equal(actuator.ctrlrange, [low, 1.0]):
            yield f"actuator '{name}' has no ctrlrange=\"{low:g} 1\""
    yield from _throttle_faults(model)
    yield from _brake_faults(model)
    yield from _steering_faults(model)
    for wheel in WHEELS:
        yield from _lock_faults(model, wheel)
    yield from _number_faults(model)


def _throttle_faults(model: mujoco.MjModel) -> Iterator[str]:
    throttle = model.actuator("throttle")
    shares = _shares_of_wheels(model, throttle)
    if shares is None or not np.isclose(sum(shares), 1.0, atol=TOLERANCE):
        found = "something else" if shares is None else f"shares that add up to {sum(shares):.4g}"
        yield (
            f"actuator 'throttle' drives {found}; expected gear 1 and a fixed tendon over joints spin_* whose coefficients "
            "add up to 1, so that its force is the torque of all driven wheels"
        )
    gains = (mujoco.mjtGain.mjGAIN_FIXED, mujoco.mjtGain.mjGAIN_AFFINE)
    biases = (mujoco.mjtBias.mjBIAS_NONE, mujoco.mjtBias.mjBIAS_AFFINE)
    gain, bias = throttle.gainprm[:3], throttle.biasprm[:3]
    if (
        int(throttle.gaintype[0]) not in gains
        or int(throttle.biastype[0]) not in biases
        or gain[0] <= 0
    ):
        yield (
            "actuator 'throttle' is no `general` with a gaintype of fixed or affine, a positive first gainprm and a "
            "biastype of none or affine"
        )
        return
    # A dead band: torque = (throttle - band) * gain(speed), with one band for all speeds.
    if (
        gain[1]
        or bias[0] > 0
        or -bias[0] >= gain[0]
        or not np.allclose(bias, bias[0] / gain[0] * gain)
    ):
        yield (
            f"actuator 'throttle' has gainprm {numbers(gain)} and biasprm {numbers(bias)}; expected gainprm "
            '"torque 0 -slope" and a biasprm that is zero or a negative share of it, the dead band'
        )
    low, high = throttle.forcerange
    if not throttle.forcelimited[0] or low != 0 or high < (gain[0] + bias[0]) * (1 - TOLERANCE):
        yield (
            f"actuator 'throttle' has no forcerange from 0 to its torque from rest, {gain[0] + bias[0]:.4g} N m, or more: "
            "it would drive backwards, or less than it says"
        )
    yield from _state_faults(model, "throttle")


def _shares_of_wheels(model: mujoco.MjModel, throttle: Any) -> list[float] | None:
    """Coefficients with which an actuator drives the spin joints, or None if it drives anything else."""
    kind, target, gear = throttle.trntype[0], throttle.trnid[0], throttle.gear[0]
    if kind != mujoco.mjtTrn.mjTRN_TENDON or gear != 1.0:
        return None
    wraps = slice(model.tendon_adr[target], model.tendon_adr[target] + model.tendon_num[target])
    spins = {model.joint(f"spin_{wheel}").id for wheel in WHEELS}
    is_fixed = (model.wrap_type[wraps] == mujoco.mjtWrap.mjWRAP_JOINT).all()
    if not is_fixed or not spins.issuperset(model.wrap_objid[wraps].tolist()):
        return None
    return model.wrap_prm[wraps].tolist()


def _brake_faults(model: mujoco.MjModel) -> Iterator[str]:
    brake = model.actuator("brake")
    if brake.gainprm.any() or brake.biasprm.any():
        yield 'actuator \'brake\' exerts a force; expected gainprm="0" biastype="none": mjdrive adds the torque'
    yield from _state_faults(model, "brake")


def _state_faults(model: mujoco.MjModel, name: str) -> Iterator[str]:
    filters = (mujoco.mjtDyn.mjDYN_FILTER, mujoco.mjtDyn.mjDYN_FILTEREXACT)
    actuator = model.actuator(name)
    if int(actuator.dyntype[0]) not in filters or actuator.actnum[0] != 1:
        yield f"actuator '{name}' has no lag; expected dyntype=\"filterexact\" and dynprm, its time constant [s]"


def _steering_faults(model: mujoco.MjModel) -> Iterator[str]:
    steer, steering = model.joint("steer"), model.actuator("steering")
    right, left = steer.range
    is_hinge = steer.type[0] == mujoco.mjtJoint.mjJNT_HINGE and np.allclose(
        steer.axis, [0, 0, 1], atol=TOLERANCE
    )
    if (
        not is_hinge
        or not steer.limited[0]
        or abs(left + right) > TOLERANCE
        or not 0 < left <= MAX_STEERING_ANGLE
    ):
        yield (
            f"joint 'steer' has the range {numbers(steer.range)} rad; expected a hinge about (0, 0, 1) with the same full "
            f'lock to both sides, at most {MAX_STEERING_ANGLE} rad (or angle="radian" is missing in <compiler>)'
        )
    slewmax = steering.dynprm[1]
    if steering.dyntype[0] != mujoco.mjtDyn.mjDYN_PID or slewmax <= 0:
        yield (
            "actuator 'steering' is no `pid` with a slewmax; expected one, from which the largest steering rate is read "
            "(a `position` or `motor` has none)"
        )
    is_on_steer = steering.trntype[0] == mujoco.mjtTrn.mjTRN_JOINT and steering.trnid[0] == steer.id
    if not is_on_steer or abs(steering.gear[0] * left - 1.0) > TOLERANCE:
        yield (
            f"actuator 'steering' has gear {steering.gear[0]:.5g}; expected it on the joint 'steer' with 1 / (full lock in "
            "rad), so that a command of 1 is full lock"
        )


def _lock_faults(model: mujoco.MjModel, wheel: str) -> Iterator[str]:
    lock = model.equality(f"lock_{wheel}")
    is_joint = lock.type[0] == mujoco.mjtEq.mjEQ_JOINT and lock.obj2id[0] == -1
    if not is_joint or lock.obj1id[0] != model.joint(f"spin_{wheel}").id or lock.active0[0]:
        yield (
            f"equality 'lock_{wheel}' is not asleep on 'spin_{wheel}' alone; expected "
            f'<joint name="lock_{wheel}" joint1="spin_{wheel}" active="false"/>'
        )


def _number_faults(model: mujoco.MjModel) -> Iterator[str]:
    for name, (count, low, high) in RANGES.items():
        values = model.numeric(name).data
        if len(values) != count or not ((low <= values) & (values <= high)).all():
            yield f"numeric '{name}' is {numbers(values)}; expected {count} from {low:g} to {high:g}"
    friction = [model.dof_frictionloss[model.joint(f"spin_{wheel}").dofadr[0]] for wheel in WHEELS]
    if len(set(friction)) != 1:
        yield f"the joints spin_* have the frictionloss {numbers(np.array(friction))}; expected one for all"
    negative = (model.dof_frictionloss < 0) | (model.dof_damping < 0) | (model.dof_armature < 0)
    for joint in sorted(set(model.dof_jntid[negative].tolist())):
        yield (
            f"joint '{model.joint(joint).name}' has a negative frictionloss, damping or armature; expected 0 or more: it "
            "would drive itself"
        )
