"""What a car file must name, and what each name is for: the only list of it in code; docs/cars.md shows the same."""

from typing import NamedTuple

import mujoco

from mjdrive.vehicle.assembly import WHEELS

CORNERS = {"fl": "front left", "fr": "front right", "rl": "rear left", "rr": "rear right"}


class Part(NamedTuple):
    """Something that a car file must name.

    Attributes:
        kind: Element of MJCF, as `MjSpec` calls it.
        name: Name that the element must have.
        purpose: What mjdrive does with it.
    """

    kind: str
    name: str
    purpose: str

    def __str__(self) -> str:
        return f"{self.kind} '{self.name}' ({self.purpose})"


PARTS = (
    Part("body", "car", "the car; its origin lies on the ground under the centre of the rear axle"),
    Part("joint", "root", "free joint of that body"),
    Part("joint", "steer", "hinge whose angle is the centre steering angle; its range is full lock"),
    *(Part("body", f"wheel_{w}", f"{CORNERS[w]} wheel, its origin in the hub") for w in WHEELS),
    *(Part("joint", f"spin_{w}", f"{CORNERS[w]} wheel turns; frictionloss is its rolling resistance") for w in WHEELS),
    *(Part("geom", f"tyre_{w}", f"{CORNERS[w]} tyre, an ellipsoid") for w in WHEELS),
    *(Part("equality", f"lock_{w}", f"locks the {CORNERS[w]} wheel at a standstill; inactive") for w in WHEELS),
    Part("geom", "hull_low", "box whose length and width are the footprint"),
    Part("actuator", "throttle", "command 0 to 1, torque on the wheels"),
    Part("actuator", "brake", "command 0 to 1; gives range and lag, the torque is added by mjdrive"),
    Part("actuator", "steering", "command -1 to 1, left is positive; `pid` on the joint steer"),
    Part("numeric", "cornering_stiffness", "of one front and one rear tyre, two numbers [N/rad]"),
    Part("numeric", "tyre_vertical_stiffness", "of one tyre [N/m]"),
    Part("numeric", "tyre_vertical_damping", "of one tyre [N s/m]"),
    Part("numeric", "brake_torque", "of all wheels together at full brake [N m]"),
    Part("numeric", "brake_front_share", "part of it on the front axle, 0 to 1 [-]"),
    Part("numeric", "drag_area", "drag coefficient times frontal area [m2]"),
    Part("camera", "chase", "view from behind"),
    Part("camera", "hood", "view of the driver"),
    Part("camera", "top", "view from above"),
)  # fmt: skip


def missing_parts(spec: mujoco.MjSpec) -> tuple[Part, ...]:
    """Find out what a car file does not name.

    Args:
        spec: The file, read and not yet compiled, so that all gaps are found at once.

    Returns:
        The parts that are missing, in the order of `PARTS`.
    """
    return tuple(part for part in PARTS if getattr(spec, part.kind)(part.name) is None)
