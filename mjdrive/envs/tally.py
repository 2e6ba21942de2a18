"""The figures of a drive while it goes on: those of `summary.json`, one step at a time."""

import math
from collections import Counter

from mjdrive.datatypes import Infraction, InfractionKind, VehicleState
from mjdrive.evaluation.metrics import RED_LIGHT_FACTOR


class Tally:
    """Adds up one drive; the sums are those of `mjdrive.evaluation.metrics`.

    Args:
        start: Where the car is at first.
        on_lane: Whether that is on a driving lane.

    Attributes:
        distance: Path length between neighbouring steps that are both on driving lanes [m].
        counts: How often each infraction happened [-].
    """

    def __init__(self, start: VehicleState, *, on_lane: bool) -> None:
        self.distance = 0.0
        self.counts: Counter[InfractionKind] = Counter()
        self._before, self._was_on_lane = start, on_lane

    def add(
        self, vehicle: VehicleState, infractions: tuple[Infraction, ...], *, on_lane: bool
    ) -> None:
        """Add a step.

        Args:
            vehicle: State of the car after it.
            infractions: Breaches of the rules in it.
            on_lane: Whether the car is on a driving lane after it.
        """
        if on_lane and self._was_on_lane:
            self.distance += math.hypot(vehicle.x - self._before.x, vehicle.y - self._before.y)
        self.counts.update(infraction.kind for infraction in infractions)
        self._before, self._was_on_lane = vehicle, on_lane

    @property
    def score(self) -> float:
        """Distance times 0.7 to the power of the red lights run [m]."""
        return self.distance * RED_LIGHT_FACTOR ** self.counts[InfractionKind.RED_LIGHT]
