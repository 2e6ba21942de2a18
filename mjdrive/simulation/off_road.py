"""Off the road: the centre of the car beyond every lane."""

import shapely

from mjdrive.config import RulesConfig
from mjdrive.datatypes import Town
from mjdrive.town import surface
from mjdrive.town.lane_index import LaneIndex

Point = tuple[float, float]


class OffRoadWatch:
    """Watches whether the car leaves the road.

    The road is what the lanes cover, with the gaps between the lanes of a junction. Leaving it counts once, until the
    centre of the car is `back_on_road` inside it again.

    Args:
        town: Where the drive takes place.
        index: Its lanes.
        config: Limits of the rules.
    """

    def __init__(self, town: Town, index: LaneIndex, config: RulesConfig) -> None:
        self._index = index
        self._road = surface.road_surface(town, shoulder=0.0)
        self._inner_road = self._road.buffer(-config.back_on_road)
        shapely.prepare(self._road)
        shapely.prepare(self._inner_road)
        self.reset()

    def reset(self) -> None:
        """Forget the drive so far."""
        self._is_away = False
        self._last_on_road: Point | None = None

    def on_road(self, point: Point) -> bool:
        """Whether a point of the world [m] lies on the road."""
        return bool(shapely.contains_xy(self._road, *point))

    def check(self, centre: Point, *, in_lane: bool = False) -> str | None:
        """Judge one control step.

        Args:
            centre: Centre of the footprint, world frame [m].
            in_lane: Whether it is known to lie well inside a lane.

        Returns:
            Name of the lane that was left, if the car has just left the road; empty if no lane is near.
        """
        if self._is_away:
            self._is_away = not shapely.contains_xy(self._inner_road, *centre)
            return None
        if in_lane or self.on_road(centre):
            self._last_on_road = centre
            return None
        self._is_away = True
        return self._lane_left(self._last_on_road or centre)

    def _lane_left(self, point: Point) -> str:
        """The lane whose edge is nearest to where the car was last on the road."""
        near = self._index.near(*point)
        beyond_edge = {place.lane: abs(place.offset) - place.half_width for place in near}
        return min(beyond_edge, key=lambda lane: beyond_edge[lane], default="")
