"""How a job ended, in a form that can be sent from one process to another."""

import traceback
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from mjdrive.errors import MjdriveError

R = TypeVar("R")


@dataclass(frozen=True, slots=True)
class Done(Generic[R]):
    """It was done: its result."""

    result: R


@dataclass(frozen=True, slots=True)
class Refused:
    """It cannot be done: a mistake that the user can mend."""

    error: MjdriveError


@dataclass(frozen=True, slots=True)
class Broken:
    """It failed: a defect of ours, with the traceback of where it happened."""

    trace: str


Outcome = Done[R] | Refused | Broken
"""One of the ways to end."""


def outcome_of(do: Callable[[], R]) -> Outcome[R]:
    """Do something; whatever comes of it can be sent.

    Args:
        do: What to do.
    """
    try:
        return Done(do())
    except MjdriveError as error:
        return Refused(error)
    except Exception:  # told, with its traceback, to whoever asked
        return Broken(traceback.format_exc())


def result_of(outcome: Outcome[R]) -> R:
    """The result; raises what went wrong elsewhere as if it had happened here.

    Args:
        outcome: How a job ended.

    Raises:
        MjdriveError: What the job raised.
        RuntimeError: If it failed by a defect.
    """
    if isinstance(outcome, Refused):
        raise outcome.error
    if isinstance(outcome, Broken):
        raise RuntimeError(f"A process that worked failed:\n{outcome.trace}")
    return outcome.result
