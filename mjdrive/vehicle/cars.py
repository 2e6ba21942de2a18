"""Which car: one that ships with mjdrive, or an MJCF of your own."""

import hashlib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from mjdrive.vehicle.assembly import car_path
from mjdrive.vehicle.parameters import VehicleParameters

SHIPPED = {"default": "car.xml", "mkz": "mkz.xml"}
DEFAULT = "default"


@dataclass(frozen=True, slots=True)
class CarModel:
    """A car that can be put into a scene.

    Attributes:
        name: How summaries call it.
        path: Its MJCF.
        parameters: Masses, lengths and limits.
        digest: SHA-256 of the MJCF, hexadecimal.
    """

    name: str
    path: Path
    parameters: VehicleParameters
    digest: str


def load(name_or_path: str | Path = DEFAULT) -> CarModel:
    """Load a car.

    Args:
        name_or_path: Name of a car that ships with mjdrive, or an MJCF file.

    Returns:
        The car, checked.

    Raises:
        CarError: If the file is missing, is no MJCF, or lacks what a car needs.
        UnknownNameError: If there is no such car.
    """
    if name_or_path in SHIPPED:
        return _shipped(str(name_or_path))
    path = Path(name_or_path)
    return _read(path.stem, path)


@cache
def _shipped(name: str) -> CarModel:
    return _read(name, car_path(SHIPPED[name]))


def _read(name: str, path: Path) -> CarModel:
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    return CarModel(name, path, VehicleParameters.read(path), digest)
