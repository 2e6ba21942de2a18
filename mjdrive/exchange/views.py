"""What the policy of an episode saw, drawn again."""

import cv2
import numpy as np
from jaxtyping import UInt8

from mjdrive.bev.picture import picture
from mjdrive.bev.projector import BevProjector
from mjdrive.config import BevConfig
from mjdrive.datatypes import Episode, Town
from mjdrive.vehicle.parameters import VehicleParameters

PICTURE_SCALE = 2
"""Pixels of a picture for one of the view [-]."""


class ViewMaker:
    """Draws bird's-eye views of the episodes of one town.

    Args:
        town: Where they were driven.
    """

    def __init__(self, town: Town) -> None:
        self._projector = BevProjector(town)

    def bev(self, episode: Episode, step: int) -> UInt8[np.ndarray, "5 192 192"]:
        """What was seen when an action was chosen.

        Args:
            episode: One of the town.
            step: Which action, from 0 [-].
        """
        return self._projector.replay(episode, step)

    def png(self, episode: Episode, step: int, parameters: VehicleParameters) -> bytes:
        """The same as people like to look at it, as a PNG file.

        Args:
            episode: One of the town.
            step: Which action, from 0 [-].
            parameters: Of the car, which is drawn into it.
        """
        bev = self.bev(episode, step)
        rgb = picture(bev, BevConfig(), parameters, scale=PICTURE_SCALE)
        works, file = cv2.imencode(".png", rgb[..., ::-1])
        assert works, "OpenCV writes PNG"
        return file.tobytes()
