"""The machine that a benchmark ran on, as far as it bears on the figures."""

import os
import platform
import time
from dataclasses import dataclass, field
from pathlib import Path

from mjdrive.execution.pool import available_cores
from mjdrive.versions import all_versions


@dataclass(frozen=True, slots=True)
class Machine:
    """Where and with what a run of the suite was made.

    Attributes:
        processor: Name of the CPU.
        num_cores: Cores that this process may use [-].
        memory_gb: Main memory; -1 where it is not known [GB].
        system: Operating system.
        versions: Of the packages that do the work.
        load: Processes that wanted to run at the start, mean over a minute; -1 where it is not known [-].
        networks: What networks find here, as pairs of a name and its value: threads, number formats, devices.
    """

    processor: str
    num_cores: int
    memory_gb: float
    system: str
    versions: dict[str, str]
    load: float
    networks: dict[str, str] = field(default_factory=dict)


class Neighbours:
    """What other programs take of the processors from now on."""

    def __init__(self) -> None:
        self._begin, self._all, self._own = time.monotonic(), _busy_s(), _own_s()

    def cores(self) -> float:
        """How many cores they kept busy so far, on the mean; -1 where it is not known [-]."""
        if self._all < 0.0:
            return -1.0
        theirs = _busy_s() - self._all - (_own_s() - self._own)
        return max(theirs / (time.monotonic() - self._begin), 0.0)


def describe() -> Machine:
    """Look at this machine; imports nothing heavy, and so says nothing of networks."""
    return Machine(
        processor=_processor(),
        num_cores=available_cores(),
        memory_gb=_memory_gb(),
        system=f"{platform.system()} {platform.machine()}",
        versions=all_versions(),
        load=round(os.getloadavg()[0], 2) if hasattr(os, "getloadavg") else -1.0,
    )


def _busy_s() -> float:
    """What all processors worked since the machine was started; -1 where it is not known [s]."""
    path = Path("/proc/stat")
    if not path.exists():
        return -1.0
    name, *ticks = path.read_text(encoding="utf-8").splitlines()[0].split()
    assert name == "cpu", name
    user, nice, system, _, _, *interrupts_and_stolen = map(int, ticks[:8])
    return (user + nice + system + sum(interrupts_and_stolen)) / os.sysconf("SC_CLK_TCK")


def _own_s() -> float:
    """What this process and those of its children that have ended worked [s]."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def _memory_gb() -> float:
    try:
        return round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9, 1)
    except (AttributeError, ValueError, OSError):  # not POSIX, or one that does not tell
        return -1.0


def _processor() -> str:
    """Name of the CPU; Linux tells it in a file."""
    path = Path("/proc/cpuinfo")
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()
