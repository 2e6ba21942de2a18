"""What can go wrong for the user: each error says what was given, what was expected and what to do."""

import difflib
from collections.abc import Iterable


class MjdriveError(Exception):
    """A mistake that the user can mend; the command line prints it in one line and exits with status 2."""

    def __reduce__(self) -> tuple[object, ...]:
        """Let it come over from another process, however its class is made."""
        return _again, (type(self), *self.args)


def _again(kind: type[MjdriveError], *args: object) -> MjdriveError:
    """Build an error from its message, without what its class makes the message from."""
    return kind.__new__(kind, *args)


class UnknownNameError(MjdriveError):
    """A name that is not one of those known here."""

    def __init__(self, kind: str, name: str, known: Iterable[str], *, hint: str = "") -> None:
        names = sorted(known)
        near = difflib.get_close_matches(name, names, n=1)
        parts = [
            f"Unknown {kind} '{name}'.",
            f"Known: {', '.join(names)}." if names else f"There is no {kind} here yet.",
            f"Did you mean '{near[0]}'?" if near else "",
            hint,
        ]
        super().__init__(" ".join(part for part in parts if part))


class NameTakenError(MjdriveError):
    """A name for something new that something else has already."""


class TownFormatError(MjdriveError):
    """A town folder or OpenDRIVE map that cannot be driven as it stands."""


class RouteError(MjdriveError):
    """Waypoints that no chain of lanes connects, or a route too short to follow."""


class CarError(MjdriveError):
    """A car file that is missing, is no MJCF, or lacks what a car needs to drive."""


class ConfigError(MjdriveError):
    """A setting out of its range, of the wrong type, or without a meaning."""


class DataError(MjdriveError):
    """A data set or episode file that is missing, truncated or made for something else."""


class RunError(MjdriveError):
    """A training run that is missing, incomplete or does not fit what is asked of it."""


class PhysicsError(MjdriveError):
    """A simulation whose motion is no longer finite."""


class RenderError(MjdriveError):
    """A picture that cannot be drawn on this machine."""


class SolverError(MjdriveError):
    """A solver that does not exist, or that this installation of casadi lacks."""


class MissingPackageError(MjdriveError):
    """A package that is not installed and that only some commands need."""

    def __init__(self, package: str, *, wanted_for: str, extra: str = "") -> None:
        what = f'--editable ".[{extra}]" in the checkout of mjdrive' if extra else package
        super().__init__(
            f"The package '{package}' is not installed; expected it for {wanted_for}. "
            f"Install it with: pip install {what}"
        )


class PluginError(MjdriveError):
    """A package that brings something along for mjdrive, and is broken."""


class WorkerError(MjdriveError):
    """A process that helped and ended before its work was done."""


class ClusterError(MjdriveError):
    """Machines that cannot be asked to work: nobody answers, or not from here."""
