"""How long a run waits for a cluster from which nothing is heard."""

import logging
import time
from collections.abc import Callable

from mjdrive.errors import ClusterError

SILENCE = 60.0
"""Time without a word after which something is said; setting up takes some 3, and a long compilation 30 [s]."""


class Patience:
    """Waits for a busy cluster and says so once; gives one up that has lost all its cores.

    Args:
        clock: Tells the time [s].
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._heard = clock()
        self._has_told = False

    def hear(self) -> None:
        """Note that a job went on or was finished."""
        self._heard = self._clock()
        self._has_told = False

    def wait(self, num_cores: float) -> None:
        """Go on waiting, if that can lead to anything.

        Args:
            num_cores: Cores that the cluster has by now [-].

        Raises:
            ClusterError: If nothing was heard for long, and there is no core that could work.
        """
        if self._clock() - self._heard < SILENCE:
            return
        if num_cores < 1:
            raise ClusterError(
                f"Nothing was heard from the Ray cluster for {SILENCE:.0f} s, and it has no core left. Expected machines "
                f"that can work; let them join again and run the same command again, which goes on from here."
            )
        if not self._has_told:
            self._has_told = True
            logging.getLogger(__name__).warning(
                "Nothing was heard from the Ray cluster for %.0f s: its %.0f cores may be busy with other work. Waiting.",
                SILENCE,
                num_cores,
            )
