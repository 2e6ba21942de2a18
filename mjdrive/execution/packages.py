"""Packages that only some ways to run jobs need."""

import importlib.util

from mjdrive.errors import MissingPackageError


def require_package(package: str, *, extra: str, wanted_for: str) -> None:
    """Refuse to go on without a package.

    Args:
        package: Its name, as imported.
        extra: The extra of mjdrive that brings it.
        wanted_for: What it is wanted for.

    Raises:
        MissingPackageError: If it is not installed.
    """
    if importlib.util.find_spec(package) is None:
        raise MissingPackageError(package, wanted_for=wanted_for, extra=extra)
