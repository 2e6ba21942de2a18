"""Which car: one that ships with mjdrive, or an MJCF file of your own."""

import hashlib
import platform
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import mujoco
from lxml import etree

from mjdrive.errors import CarError, UnknownNameError, WorkerError
from mjdrive.vehicle.assembly import car_on_road, car_path
from mjdrive.vehicle.car_control_checks import control_faults
from mjdrive.vehicle.car_file_checks import file_faults
from mjdrive.vehicle.car_parts import missing_parts
from mjdrive.vehicle.car_shape_checks import shape_faults
from mjdrive.vehicle.car_trial import trial_faults
from mjdrive.vehicle.parameters import VehicleParameters

SHIPPED = {"default": "car.xml", "mkz": "mkz.xml"}
DEFAULT = "default"
TIMESTEP = 0.005  # of the trial drive [s]


@dataclass(frozen=True, slots=True)
class CarModel:
    """A car that can be put into a scene.

    Attributes:
        name: How summaries call it: its name, or that of its file.
        path: Its MJCF.
        parameters: Masses, lengths and limits.
        digest: SHA-256 of the MJCF and, after it, of every file that it includes or loads, hexadecimal.
    """

    name: str
    path: Path
    parameters: VehicleParameters
    digest: str


def load(name_or_path: str | Path = DEFAULT) -> CarModel:
    """Load a car and check that it can drive.

    Args:
        name_or_path: Name of a car that ships with mjdrive, or an MJCF file.

    Returns:
        The car.

    Raises:
        CarError: If the file is missing, is no MJCF, or lacks what a car needs.
        UnknownNameError: If there is no such car.
    """
    if name_or_path in SHIPPED:
        return _shipped(str(name_or_path))
    path = Path(name_or_path)
    if path.suffix != ".xml" and not path.is_file():
        raise UnknownNameError(
            "car", str(name_or_path), SHIPPED, hint="Or give an MJCF file, my_car.xml."
        )
    return _load_file(path.name, path)


def require_same(car: CarModel) -> None:
    """Refuse to drive a car whose files are not, on this machine and by now, those that it was loaded from.

    Args:
        car: As it was loaded, perhaps elsewhere.

    Raises:
        WorkerError: If its files are missing here, or differ.
    """
    try:
        found = _digest(car.path, mujoco.MjSpec.from_file(str(car.path)))
    except (OSError, ValueError) as error:
        found = f"nothing that can be read ({' '.join(str(error).split())})"
    if found != car.digest:
        raise WorkerError(
            f"On the machine '{platform.node()}' the car '{car.path}' is {found}; expected the files that it was loaded "
            f"from, {car.digest}. Put them at the same place on all machines."
        )


@cache
def _shipped(name: str) -> CarModel:
    return _load_file(name, car_path(SHIPPED[name]))


def _load_file(name: str, path: Path) -> CarModel:
    """Check a file step by step; each step relies on the one before it."""
    if not path.is_file():
        raise CarError(
            f"There is no car file '{path}'. Give an MJCF file, or one of: {', '.join(SHIPPED)}."
        )
    try:
        spec = mujoco.MjSpec.from_file(str(path))
        _refuse(path, "lacks", (str(part) for part in missing_parts(spec)))
        _refuse(path, "cannot be put into a town", file_faults(spec))
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # MuJoCo warns of a car that it can hardly simulate
            model = car_on_road(timestep=TIMESTEP, car=path).compile()
    except (ValueError, UserWarning) as error:
        raise CarError(
            f"MuJoCo cannot read the car file '{path}': {' '.join(str(error).split())} Expected MJCF, as in docs/cars.md."
        ) from error
    _refuse(path, "cannot drive", [*shape_faults(model), *control_faults(model)])
    parameters = VehicleParameters.of(model)
    _refuse(path, "does not drive as a car", trial_faults(model))
    return CarModel(name, path, parameters, _digest(path, spec))


def _refuse(path: Path, verdict: str, faults: Iterable[str]) -> None:
    found = "; ".join(faults)
    if found:
        raise CarError(f"Car '{path}' {verdict}: {found}. See 'A car of your own' in docs/cars.md.")


def _digest(path: Path, spec: mujoco.MjSpec) -> str:
    """Digest of a file, of what it includes, and of its meshes, textures and height fields, in the order of the file."""
    folders = [
        (spec.meshes, spec.meshdir),
        (spec.textures, spec.texturedir),
        (spec.hfields, spec.meshdir),
    ]
    loaded = [
        path.parent / folder / asset.file
        for assets, folder in folders
        for asset in assets
        if asset.file
    ]
    digest = hashlib.sha256()
    for part in (*_with_includes(path, path.parent), *loaded):
        digest.update(part.read_bytes())
    return digest.hexdigest()


def _with_includes(path: Path, folder: Path) -> list[Path]:
    """A file of MJCF and the files that it includes; MuJoCo looks for them in the folder of the outermost one."""
    inner = [folder / element.get("file") for element in etree.parse(path).iter("include")]
    return [path, *(part for file in inner for part in _with_includes(file, folder))]
