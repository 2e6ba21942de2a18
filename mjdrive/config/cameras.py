"""Settings of the cameras that a policy may look through."""

import math
from dataclasses import dataclass

from mjdrive.config.json_files import require


@dataclass(frozen=True, slots=True)
class CameraConfig:
    """Three cameras above the bonnet: half to the left, ahead, half to the right.

    Attributes:
        width_px: Of each picture [px].
        height_px: Of each picture [px].
        field_of_view: Angle between the left and the right edge of a picture [rad].
        sideways: Yaw of the outer cameras; the left one looks so far to the left [rad].
        ahead: Place of all three, ahead of the middle of the car, as CARLA counts it [m].
        height: Place of all three above the ground [m].
        shadows: Whether the sun throws shadows; without a GPU pictures with them take eight times as long.
    """

    width_px: int = 256
    height_px: int = 144
    field_of_view: float = math.radians(90.0)
    sideways: float = math.radians(45.0)
    ahead: float = 1.2
    height: float = 1.3
    shadows: bool = False

    def __post_init__(self) -> None:
        for name in ("width_px", "height_px"):
            value = getattr(self, name)
            require(value >= 8, f"{name} of the cameras is {value}; expected at least 8 px.")
        require(
            0.0 < self.field_of_view < math.pi,
            f"field_of_view of the cameras is {self.field_of_view:g} rad; expected between 0 and 3.14.",
        )
        require(
            0.0 <= self.sideways <= math.pi,
            f"sideways of the cameras is {self.sideways:g} rad; expected between 0 and 3.14.",
        )
        require(
            math.isfinite(self.ahead),
            f"ahead of the cameras is {self.ahead:g} m; expected a finite number.",
        )
        require(
            0.0 < self.height < math.inf,
            f"height of the cameras is {self.height:g} m; expected over 0, not infinite.",
        )
