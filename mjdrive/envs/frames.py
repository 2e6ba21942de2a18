"""Pictures of a drive for people: what the car sees, and where it is in the town. Drawn without OpenGL."""

import cv2
import numpy as np
from jaxtyping import UInt8

from mjdrive.bev import picture as bev_picture
from mjdrive.config import BevConfig
from mjdrive.datatypes import Observation, VehicleState
from mjdrive.simulation.cameras import Cameras
from mjdrive.simulation.simulation import Simulation
from mjdrive.town.picture import Sheet, draw

CAMERAS = ("chase", "hood", "top")
"""Views that need OpenGL."""

MAP = "map"
"""The view that needs none."""

HEIGHT = 2 * BevConfig().size_px
"""Of a picture [px]."""

CAMERA_WIDTH = HEIGHT * 16 // 9
"""Of a picture that a camera takes [px]."""

_SUBPIXELS = 4  # binary digits
_CAR_RADIUS = 5.0  # on the map [px]


class MapFrames:
    """Draws the bird's-eye view beside the town, with the way so far.

    Args:
        simulation: What to draw.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._ground = draw(simulation.town)
        self._sheet = Sheet(simulation.town)
        self._path: list[tuple[float, float]] = []

    def reset(self) -> None:
        """Forget the way so far."""
        self._path = []

    def follow(self, vehicle: VehicleState) -> None:
        """Lengthen the way by a step."""
        self._path.append((vehicle.x, vehicle.y))

    def draw(self, seen: Observation) -> UInt8[np.ndarray, "H W 3"]:
        """Draw one picture.

        Args:
            seen: What the car sees now.

        Returns:
            Red, green, blue, top row first [-].
        """
        view = bev_picture.picture(seen.bev, BevConfig(), self._simulation.car.parameters, scale=2)
        return np.hstack([view, self._map()])

    def close(self) -> None:
        """Nothing is held."""

    def _map(self) -> UInt8[np.ndarray, "H W 3"]:
        """The whole town, as high as the view."""
        scale = HEIGHT / self._ground.shape[0]
        size = round(scale * self._ground.shape[1]), HEIGHT
        image = cv2.resize(self._ground, size, interpolation=cv2.INTER_AREA)
        vehicle = self._simulation.vehicle
        path = scale * self._sheet.pixels(np.array([*self._path, (vehicle.x, vehicle.y)]))
        fine = np.rint(path * 2**_SUBPIXELS).astype(np.int32)
        cv2.polylines(image, [fine], False, bev_picture.CAR, 2, cv2.LINE_AA, _SUBPIXELS)
        radius = round(_CAR_RADIUS * 2**_SUBPIXELS)
        place = tuple(fine[-1].tolist())
        cv2.circle(image, place, radius, bev_picture.CAR, cv2.FILLED, cv2.LINE_AA, _SUBPIXELS)
        return np.asarray(image)


class CameraFrames:
    """Lets a camera of the scene take pictures.

    Args:
        simulation: What to draw.
        camera: One of `CAMERAS`.

    Raises:
        RenderError: If there is no OpenGL here.
    """

    def __init__(self, simulation: Simulation, camera: str) -> None:
        self._simulation, self._camera = simulation, camera
        self._cameras = Cameras(simulation.model, width=CAMERA_WIDTH, height=HEIGHT)

    def reset(self) -> None:
        """Nothing is remembered."""

    def follow(self, vehicle: VehicleState) -> None:
        """Nothing is remembered."""

    def draw(self, seen: Observation) -> UInt8[np.ndarray, "H W 3"]:
        """Take one picture; what the car itself sees does not matter.

        Returns:
            Red, green, blue, top row first [-].
        """
        return np.ascontiguousarray(self._cameras.render(self._simulation.data, self._camera))

    def close(self) -> None:
        """Give the memory of OpenGL back."""
        self._cameras.close()
