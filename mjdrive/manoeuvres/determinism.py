"""The same seed gives the same bytes: again, in another process, with other numbers of threads."""

import hashlib
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from mjdrive.manoeuvres.bars import Bar
from mjdrive.manoeuvres.random_driving import advance, random_actions
from mjdrive.manoeuvres.rig import Rig

SEED = 7
DURATION = 60.0  # [s]
NUM_AT_ONCE = 4
_THREAD_COUNTS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
_SCRIPT = (
    "import sys; from pathlib import Path; from mjdrive.manoeuvres.determinism import digest; "
    "car = Path(sys.argv[2]) if sys.argv[2] else None; print(digest(car, float(sys.argv[1])))"
)


def digest(car: Path | None = None, duration: float = DURATION) -> str:
    """SHA-256 of every state of a random drive, hexadecimal.

    Args:
        car: MJCF; the default car if None.
        duration: Of the drive [s].
    """
    rig, sha = Rig.of_car(car), hashlib.sha256()
    for action in random_actions(np.random.default_rng(SEED), duration):
        rig.car.command(action)
        advance(rig)
        sha.update(rig.data.qpos.tobytes() + rig.data.qvel.tobytes())
    return sha.hexdigest()


def digest_elsewhere(
    car: Path | None = None, duration: float = DURATION, *, num_threads: int
) -> str:
    """The same digest from another process.

    Args:
        car: MJCF; the default car if None.
        duration: Of the drive [s].
        num_threads: That its libraries may use [-].
    """
    environment = os.environ | dict.fromkeys(_THREAD_COUNTS, str(num_threads))
    words = [sys.executable, "-c", _SCRIPT, str(duration), str(car or "")]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
    return done.stdout.strip()


def digests_at_once(car: Path | None = None, duration: float = DURATION) -> list[str]:
    """The digests of four drives in four threads of this process.

    Args:
        car: MJCF; the default car if None.
        duration: Of each drive [s].
    """
    with ThreadPoolExecutor(NUM_AT_ONCE) as pool:
        return list(pool.map(lambda _: digest(car, duration), range(NUM_AT_ONCE)))


def bars(car: Path | None = None, duration: float = DURATION) -> tuple[Bar, ...]:
    """Count the digests that differ from the first one.

    Args:
        car: MJCF; the default car if None.
        duration: Of each drive [s].
    """
    first = digest(car, duration)
    elsewhere = [digest_elsewhere(car, duration, num_threads=count) for count in (1, NUM_AT_ONCE)]
    others = [digest(car, duration), *elsewhere, *digests_at_once(car, duration)]
    different = float(sum(other != first for other in others))
    reason = f"again; in processes of 1 and {NUM_AT_ONCE} threads; {NUM_AT_ONCE} drives at once"
    name = f"same seed, {len(others)} drives of {duration:.0f} s"
    return (Bar(name, "drives of other bytes", different, "drives", most=0.0, reason=reason),)
