"""Body, wheels, tyres and hull of a car file: what would break physics or rules without a word."""

from collections.abc import Iterator

import mujoco
import numpy as np
from jaxtyping import Float

from mjdrive.vehicle.assembly import WHEELS

TOLERANCE = 0.01  # of places [m]
RADIUS_TOLERANCE = 1e-4  # [m]
MASSES = (200.0, 5000.0)  # what one car may weigh [kg]
LARGEST = (20.0, 4.0)  # length and width of a footprint [m]
TYRE_BITS = (4, 2)  # contype, conaffinity
HULL_BITS = ((0, 8), (0, 10))
LEFT = np.array([0.0, 1.0, 0.0])


def shape_faults(model: mujoco.MjModel) -> Iterator[str]:
    """Name every fault in the shape of a car.

    Args:
        model: The car on a plane, with every name of `car_parts.PARTS`.

    Yields:
        What was found and what was expected, one clause each.
    """
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    yield from _body_faults(model, data)
    hubs = np.array([data.body(f"wheel_{wheel}").xpos for wheel in WHEELS])
    if (hubs[0, :2] <= 0).any():
        yield (
            f"the hub of 'wheel_fl' is at {numbers(hubs[0])} m; expected it ahead of the origin, which lies under the "
            "rear axle (x > 0), and on the left (y > 0)"
        )
    else:
        yield from _hub_faults(hubs, radius=float(model.geom("tyre_fl").size[0]))
        yield from _footprint_faults(model, hubs)
    for wheel in WHEELS:
        yield from _wheel_faults(model, data, wheel)
    yield from _contact_faults(model)


def numbers(values: Float[np.ndarray, " N"]) -> str:
    """Write a few numbers for people."""
    return f"({', '.join(f'{value:.4g}' for value in values)})"


def _body_faults(model: mujoco.MjModel, data: mujoco.MjData) -> Iterator[str]:
    root, car = model.joint("root"), model.body("car")
    is_free = root.type[0] == mujoco.mjtJoint.mjJNT_FREE and root.bodyid[0] == car.id
    if not is_free or root.qposadr[0] != 0:
        yield "joint 'root' does not free the body 'car'; expected <freejoint name=\"root\"/> first in it"
    place, turn = data.body("car").xpos, data.body("car").xmat
    if not (np.allclose(place, 0.0) and np.allclose(turn, np.eye(3).ravel())):
        yield (
            f"the body 'car' begins at {numbers(place)} m or is turned; expected it at the origin: leave out its pos and "
            "its orientation"
        )
    mass = float(car.subtreemass[0])
    if not MASSES[0] <= mass <= MASSES[1]:
        yield f"the car weighs {mass:,.0f} kg; expected {MASSES[0]:,.0f} to {MASSES[1]:,.0f} kg"


def _hub_faults(hubs: Float[np.ndarray, "4 3"], *, radius: float) -> Iterator[str]:
    """Compare the hubs with those of a car that stands on its wheels, mirrored, with its origin under the rear axle."""
    wheelbase, side = hubs[0, :2]
    corners = [(wheelbase, side), (wheelbase, -side), (0.0, side), (0.0, -side)]
    for wheel, hub, corner in zip(WHEELS, hubs, corners, strict=True):
        expected = np.array([*corner, radius])
        if np.abs(hub - expected).max() > TOLERANCE:
            yield (
                f"the hub of 'wheel_{wheel}' is at {numbers(hub)} m; expected {numbers(expected)} m, as 'wheel_fl', the "
                "tyre radius and an origin on the ground under the centre of the rear axle ask for"
            )


def _footprint_faults(model: mujoco.MjModel, hubs: Float[np.ndarray, "4 3"]) -> Iterator[str]:
    hull = model.geom("hull_low")
    is_unturned = hull.bodyid[0] == model.body("car").id and np.allclose(hull.quat, [1, 0, 0, 0])
    if hull.type[0] != mujoco.mjtGeom.mjGEOM_BOX or not is_unturned:
        yield "geom 'hull_low' is not an unturned box in the body 'car'"
        return
    low, high = (hull.pos - hull.size)[:2], (hull.pos + hull.size)[:2]
    covers_hubs = (low <= hubs[:, :2]).all() and (hubs[:, :2] <= high).all()
    if not covers_hubs or not (high - low <= LARGEST).all():
        yield (
            f"geom 'hull_low' reaches from {numbers(low)} to {numbers(high)} m; expected it over all four hubs and at most "
            f"{LARGEST[0]:g} m by {LARGEST[1]:g} m: it is the footprint"
        )


def _wheel_faults(model: mujoco.MjModel, data: mujoco.MjData, wheel: str) -> Iterator[str]:
    hub, spin, tyre = (
        model.body(f"wheel_{wheel}"),
        model.joint(f"spin_{wheel}"),
        model.geom(f"tyre_{wheel}"),
    )
    is_hinge = spin.type[0] == mujoco.mjtJoint.mjJNT_HINGE and spin.bodyid[0] == hub.id
    if not is_hinge or spin.limited[0] or data.joint(spin.name).xaxis @ LEFT < 0.999:
        yield (
            f"joint 'spin_{wheel}' is no hinge of 'wheel_{wheel}' without limits about the axis (0, 1, 0), which makes "
            "rolling forward positive"
        )
    radius = float(model.geom("tyre_fl").size[0])
    is_round = np.abs(tyre.size[[0, 2]] - radius).max() < RADIUS_TOLERANCE
    if tyre.type[0] != mujoco.mjtGeom.mjGEOM_ELLIPSOID or not is_round:
        yield (
            f"geom 'tyre_{wheel}' is no ellipsoid with a radius of {radius:.4g} m, that of 'tyre_fl', in x and z; an "
            "ellipsoid meets the road in one point, and all four tyres share one radius"
        )
    is_centred = np.allclose(data.geom(tyre.name).xpos, data.body(hub.name).xpos, atol=TOLERANCE)
    if tyre.bodyid[0] != hub.id or not is_centred:
        yield f"geom 'tyre_{wheel}' does not lie in the middle of the body 'wheel_{wheel}'"
    if tyre.priority[0] < 1:
        yield f"geom 'tyre_{wheel}' has priority {tyre.priority[0]}; expected 1, so that kerbs meet the tyre's spring"


def _contact_faults(model: mujoco.MjModel) -> Iterator[str]:
    tyres = {f"tyre_{wheel}" for wheel in WHEELS}
    for geom in (model.geom(index) for index in range(model.ngeom)):
        bits = int(geom.contype[0]), int(geom.conaffinity[0])
        allowed: tuple[tuple[int, int], ...]
        if geom.name in tyres:
            allowed = (TYRE_BITS,)
        else:
            allowed = HULL_BITS if geom.name.startswith("hull_") else ((0, 0),)
        if geom.bodyid[0] != 0 and bits not in allowed:
            expected = " or ".join(f"{contype}/{conaffinity}" for contype, conaffinity in allowed)
            yield (
                f"geom '{geom.name}' has contype/conaffinity {bits[0]}/{bits[1]}; expected {expected}: tyres 4/2, what can "
                "be hit is called hull_<name> and has 0/8 (0/10 to meet the road in a roll-over), all else 0/0"
            )
