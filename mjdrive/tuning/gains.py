"""The file of tuned settings and its evidence."""

import dataclasses
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from mjdrive import config
from mjdrive.config import CollectConfig, MpcConfig, PidConfig
from mjdrive.errors import ConfigError
from mjdrive.tuning.marks import Marks
from mjdrive.vehicle.cars import CarModel

FORMAT = "mjdrive-gains-1"

WORSE = 1.02
"""A cost that rises by less than this factor is as good as before [-]."""

Settings = TypeVar("Settings", PidConfig, MpcConfig)


@dataclass(frozen=True, slots=True)
class Evidence:
    """How the settings drove one town, before and after they were tuned.

    Attributes:
        town: Name of the town.
        town_digest: Digest of the town.
        before: Marks of the settings at the start.
        after: Marks of the tuned settings.
    """

    town: str
    town_digest: str
    before: Marks
    after: Marks


@dataclass(frozen=True, slots=True)
class Gains:
    """Tuned settings of an expert for one car.

    Attributes:
        expert: Name of the expert.
        car: Name of the car.
        car_digest: SHA-256 of its MJCF, hexadecimal.
        settings: All settings of the expert, tuned or not, as JSON values.
        tuned: Names of the settings that were tuned.
        tuned_on: How they drove the town that they were tuned on.
        checked_on: How they drove a town that the search never saw, or None if there was none.
        trials: Settings that were tried [-].
        seed: Seed of the search [-].
        search: Settings of the search, as JSON values.
        versions: Versions of the software that drove.
        format: Version of this description.
    """

    expert: str
    car: str
    car_digest: str
    settings: dict[str, Any]
    tuned: tuple[str, ...]
    tuned_on: Evidence
    checked_on: Evidence | None
    trials: int
    seed: int
    search: dict[str, Any]
    versions: dict[str, str]
    format: str = FORMAT

    @property
    def doubt(self) -> str:
        """What a town that the search never saw says against them; empty if it drives well, or there is none."""
        checked = self.checked_on
        if checked is None or checked.town_digest == self.tuned_on.town_digest:
            return ""
        before, after = checked.before, checked.after
        if after.cost <= WORSE * before.cost and after.mishaps <= before.mishaps:
            return ""
        return (
            f"In {checked.town}, which the search never saw, the tuned settings drive worse than those before: cost {after.cost:.2f} "
            f"instead of {before.cost:.2f}, mishaps {after.mishaps} instead of {before.mishaps}. Tune in the town that is harder to drive: "
            f"`mjdrive tune {self.expert} --town {checked.town} --check-town {self.tuned_on.town}`."
        )


def load(path: Path, kind: type[Settings], car: CarModel) -> Settings:
    """Read tuned settings for an expert in a car.

    Args:
        path: File that `mjdrive tune` wrote.
        kind: Settings of the expert that shall use them.
        car: The car that it shall drive.

    Returns:
        All settings of the expert.

    Raises:
        ConfigError: If the file is no such file, or was made for another expert or another car.
    """
    try:
        gains = config.read_json(Gains, path)
    except ConfigError as error:
        raise ConfigError(f"'{path}' holds no tuned settings. {error}") from error
    expert = {PidConfig: "pid", MpcConfig: "mpc"}[kind]
    config.require(
        gains.format == FORMAT, f"'{path}' has format '{gains.format}'; expected '{FORMAT}'."
    )
    again = f"Tune again: `mjdrive tune {expert} --car {car.name}`."
    if gains.expert != expert:
        raise ConfigError(
            f"'{path}' was tuned for the expert {gains.expert}, not {expert}. {again}"
        )
    if gains.car_digest != car.digest:
        raise ConfigError(
            f"'{path}' was tuned for car '{gains.car}' {gains.car_digest[:12]}; driven is '{car.name}' "
            f"{car.digest[:12]}. {again}"
        )
    try:
        return config.from_dict(kind, gains.settings)
    except ConfigError as error:
        raise ConfigError(f"'{path}' cannot be used: {error} {again}") from error


def applied(settings: CollectConfig, path: Path, car: CarModel) -> CollectConfig:
    """Let the expert of some settings drive with tuned ones.

    Args:
        settings: Who drives, and how.
        path: File that `mjdrive tune` wrote.
        car: The car that is driven.

    Returns:
        The same with the tuned settings of that expert.

    Raises:
        ConfigError: If the file is no such file, or was made for another expert or another car.
    """
    if settings.expert == "pid":
        return dataclasses.replace(settings, pid=load(path, PidConfig, car))
    return dataclasses.replace(settings, mpc=load(path, MpcConfig, car))


def plain(settings: object) -> dict[str, Any]:
    """Settings as JSON values."""
    return json.loads(config.to_json(settings))
