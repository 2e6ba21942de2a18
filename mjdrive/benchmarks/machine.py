"""The machine that a benchmark ran on, as far as it bears on the figures."""

import os
import platform
from dataclasses import dataclass
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
    """

    processor: str
    num_cores: int
    memory_gb: float
    system: str
    versions: dict[str, str]
    load: float


def describe() -> Machine:
    """Look at this machine; imports nothing heavy."""
    return Machine(
        processor=_processor(),
        num_cores=available_cores(),
        memory_gb=_memory_gb(),
        system=f"{platform.system()} {platform.machine()}",
        versions=all_versions(),
        load=round(os.getloadavg()[0], 2) if hasattr(os, "getloadavg") else -1.0,
    )


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
