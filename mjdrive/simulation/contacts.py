"""Which contacts of the car matter to the rules."""

import mujoco
import numpy as np

from mjdrive.datatypes import InfractionKind

_ROAD, _HULL, _TYRE, _KERB, _OBSTACLE = range(5)
_ROLES = {"hull": _HULL, "tyre": _TYRE, "kerb": _KERB, "road": _ROAD}
"""By the first word of a geom's name; whatever else can be touched is an obstacle."""

_TYRE_ON_ROAD = {_ROAD, _TYRE}

_MOST_MET = 1000
"""Sets of contacts that are remembered at once [-]."""

Hit = tuple[InfractionKind, str]


class ContactWatch:
    """Names what the car touches, from the contacts of the last physics step.

    Args:
        model: Compiled scene; geoms are known by the first word of their name.
        data: Its state.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._data = data
        self._names = [model.geom(index).name for index in range(model.ngeom)]
        self._role = np.array([_ROLES.get(name.split("_")[0], _OBSTACLE) for name in self._names])
        self._met: dict[bytes, frozenset[Hit]] = {}

    def hits(self) -> frozenset[Hit]:
        """Everything that the car touches now, tyres on the road left out.

        Returns:
            Kind and name of each thing; all kerbs share the name "kerb", so one scrape is one event.
        """
        pairs = self._data.contact.geom
        key = pairs.tobytes()  # a car on its wheels touches the same again and again
        if key not in self._met:
            if len(self._met) >= _MOST_MET:
                self._met.clear()
            self._met[key] = frozenset(self._hits_of(pairs))
        return self._met[key]

    def _hits_of(self, pairs: np.ndarray) -> set[Hit]:
        """What pairs of geoms that touch mean, shape (N, 2)."""
        found: set[Hit] = set()
        for pair in pairs:
            roles = {int(role) for role in self._role[pair]}
            if roles == _TYRE_ON_ROAD or not roles & {_HULL, _TYRE}:
                continue
            if roles == {_TYRE, _KERB}:
                found.add((InfractionKind.KERB, "kerb"))
            elif _KERB in roles:
                found.add((InfractionKind.COLLISION, "kerb"))
            else:
                others = [
                    self._names[geom] for geom in pair if self._role[geom] not in (_HULL, _TYRE)
                ]
                found.update((InfractionKind.COLLISION, name) for name in others)
        return found

    def obstacles(self) -> list[str]:
        """Names of the things, road and kerbs left out, that the car touches now."""
        return sorted(
            name
            for kind, name in self.hits()
            if kind is InfractionKind.COLLISION and name not in ("kerb", "road")
        )
