"""Minari data sets -> episodes, where they say where the car was.

Needed of each episode: attributes `town` and `light_phase`; `infos/time` (T,), `infos/vehicle` (T, 6) as in `Episode`; and
`actions` (T or T - 1, 2). Taken if they are there: `infos/actions`, `infos/labels`, `infos/physics`, `infos/on_lane`, and
the attributes name, policy, seed, infractions and metadata. `mjdrive export --to minari` writes all of them.
"""

import json
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from mjdrive.datatypes import Episode, Infraction, InfractionKind
from mjdrive.errors import DataError
from mjdrive.exchange.minari import MAIN, METADATA
from mjdrive.exchange.sources import Recording

NEEDED = ("town", "light_phase", "infos/time", "infos/vehicle", "actions")
"""Attributes and arrays without which an episode is none of ours."""


def read(folder: Path) -> list[Recording]:
    """Read a data set.

    Raises:
        DataError: If there is none, it is of another format, or it does not say where the car was.
    """
    for place in (folder, folder / "data"):
        if (place / METADATA).is_file() and (place / MAIN).is_file():
            break
    else:
        raise DataError(
            f"'{folder}' is no Minari data set in HDF5; expected {METADATA} and {MAIN} in it, or in its folder data/."
        )
    try:
        with h5py.File(place / MAIN, "r") as file:
            names = sorted(file, key=lambda name: int(name.rsplit("_", 1)[1]))
            for name in names:
                _require_fields(file[name], f"{place / MAIN}: {name}")
            found = [_recording(file[name], name) for name in names]
    except (OSError, ValueError, KeyError) as error:
        raise DataError(
            f"'{place / MAIN}' is no whole Minari file: {error}. Fetch it again."
        ) from error
    if not found:
        raise DataError(f"'{folder}' holds no episode; expected at least one.")
    return found


def _require_fields(group: h5py.Group, where: str) -> None:
    missing = [name for name in NEEDED if name not in group and name not in group.attrs]
    if missing:
        raise DataError(
            f"'{where}' has no {', '.join(missing)}; it has {', '.join(_names(group))}. Views are drawn again from town, "
            f"place, heading and time, so observations alone cannot be taken over. Record them as "
            f"`mjdrive export --to minari` does (docs/recordings.md)."
        )


def _names(group: h5py.Group) -> list[str]:
    found: list[str] = list(group.attrs)
    group.visititems(lambda name, it: found.append(name) if isinstance(it, h5py.Dataset) else None)
    return found


def _recording(group: h5py.Group, name: str) -> Recording:
    attributes, vehicle = group.attrs, group["infos/vehicle"][()].astype(float)
    actions = _actions(group, len(vehicle))
    steps = len(actions)  # without the one after the last action, where that was not kept
    time = group["infos/time"][()].astype(float)
    if vehicle.ndim != 2 or vehicle.shape[1] != 6 or len(time) != len(vehicle):
        raise ValueError(
            f"{name} has infos/vehicle of shape {vehicle.shape} and infos/time of {time.shape}, not (T, 6) and (T,)"
        )
    episode = Episode(
        town=str(attributes["town"]),
        policy=str(attributes.get("policy", "unknown")),
        seed=int(attributes.get("seed", 0)),
        light_phase=float(attributes["light_phase"]),
        time=time[:steps],
        physics=_optional(group, "physics", np.zeros((steps, 0)), steps),
        vehicle=vehicle[:steps],
        actions=actions,
        labels=_optional(group, "labels", actions, steps),
        on_lane=_optional(group, "on_lane", np.ones(steps, bool), steps),
        infractions=tuple(map(_infraction, json.loads(attributes.get("infractions", "[]")))),
        metadata=json.loads(attributes.get("metadata", "{}")),
    )
    return Recording(str(attributes.get("name", name)), episode)


def _actions(group: h5py.Group, count: int) -> np.ndarray:
    """What was driven: as it was recorded, or else as Minari has it, in single precision."""
    driven: np.ndarray = group["infos/actions" if "infos/actions" in group else "actions"][()]
    if driven.ndim != 2 or driven.shape[1] != 2 or len(driven) not in (count, count - 1):
        raise ValueError(
            f"actions have the shape {driven.shape}, not ({count}, 2): acceleration and steering"
        )
    return driven.astype(float)


def _optional(group: h5py.Group, name: str, default: np.ndarray, steps: int) -> np.ndarray:
    """An array of `infos`, or what stands for it."""
    place = f"infos/{name}"
    return np.asarray(group[place][()][:steps]) if place in group else default


def _infraction(it: dict[str, Any]) -> Infraction:
    kind = InfractionKind[it["kind"].upper()]
    return Infraction(kind, float(it["time"]), float(it["x"]), float(it["y"]), str(it["cause"]))
