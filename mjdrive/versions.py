"""Versions of what decides the bytes that mjdrive writes."""

import functools
import hashlib
import importlib.metadata
import importlib.util
import platform
from collections.abc import Mapping
from pathlib import Path

import mjdrive
from mjdrive.errors import WorkerError

PREFIX = "version."
"""`Episode.metadata` names that begin so hold the version of a package."""

_SOURCES = (".py", ".jinja", ".xml")
"""Endings of the files that code consists of."""

_OPENCV = (
    "opencv-python-headless",
    "opencv-python",
    "opencv-contrib-python-headless",
    "opencv-contrib-python",
)
"""Names under which the module cv2 may be installed."""


def versions() -> dict[str, str]:
    """Versions of mjdrive, Python, MuJoCo, NumPy and torch, without importing them."""
    packages = ("mujoco", "numpy", "torch")
    return {
        "mjdrive": mjdrive.__version__,
        "python": platform.python_version(),
        **{name: importlib.metadata.version(name) for name in packages},
    }


def all_versions() -> dict[str, str]:
    """Those of `versions`, and of the other packages that decide views, solutions, files or pictures."""
    return {
        **versions(),
        **{name: version_of(name) for name in ("casadi", "h5py", "matplotlib", "shapely")},
        "opencv": version_of(*_OPENCV),
    }


def version_of(*packages: str) -> str:
    """Version of the first of some packages that is installed; "unknown" if none is.

    Args:
        packages: Names under which a package may be installed.
    """
    for package in packages:
        try:
            return importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            continue
    return "unknown"


@functools.cache
def code_digest() -> str:
    """SHA-256 of the sources of mjdrive and models when it was first asked for, hexadecimal.

    A version stays while code changes; this does not.
    """
    return digest_of_sources(*(_folder_of(name) for name in ("mjdrive", "models")))


def digest_of_sources(*packages: Path) -> str:
    """SHA-256 of the code in some folders, names of files included, hexadecimal.

    Args:
        packages: Folders of packages; where they are does not count, what they are called does.
    """
    total = hashlib.sha256()
    for package in packages:
        for path in sorted(it for it in package.rglob("*") if it.suffix in _SOURCES):
            content = hashlib.sha256(path.read_bytes()).hexdigest()
            total.update(
                f"{package.name}/{path.relative_to(package).as_posix()} {content}\n".encode()
            )
    return total.hexdigest()


def _folder_of(package: str) -> Path:
    """Where a package is, without importing it."""
    spec = importlib.util.find_spec(package)
    assert spec is not None, f"{package} is installed with mjdrive"
    assert spec.origin is not None, f"{package} has an __init__.py"
    return Path(spec.origin).parent


def require_same(expected: Mapping[str, str]) -> None:
    """Refuse to work for a machine of other versions, whose bytes would differ.

    Args:
        expected: Versions of the machine that asked.

    Raises:
        WorkerError: If they differ from those here.
    """
    here = all_versions()
    differing = sorted(name for name in expected if here.get(name) != expected[name])
    if differing:
        raise WorkerError(
            f"The machine '{platform.node()}' has {_listed(here, differing)}; expected {_listed(expected, differing)}, as "
            f"where the command was given. Install the same versions on all machines."
        )


def _listed(versions: Mapping[str, str], names: list[str]) -> str:
    return ", ".join(f"{name} {versions.get(name, 'unknown')}" for name in names)


def to_metadata(versions: Mapping[str, str]) -> dict[str, str]:
    """Name versions as `Episode.metadata` does."""
    return {PREFIX + package: version for package, version in versions.items()}


def from_metadata(metadata: Mapping[str, str]) -> dict[str, str]:
    """The versions that the metadata of an episode hold, by package; undoes `to_metadata`."""
    return {
        name.removeprefix(PREFIX): version
        for name, version in sorted(metadata.items())
        if name.startswith(PREFIX)
    }
