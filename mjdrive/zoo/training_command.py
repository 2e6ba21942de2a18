"""The command that trains a run again, from the settings that it left."""

import json
import shlex
from pathlib import Path
from typing import Any

from models import presets, serialization
from models.config import LearnerConfig, Method

_SECTIONS: dict[Method, set[str]] = {
    "bc-beta": {"beta"},
    "bc-mixture": {"beta", "mixture"},
    "bc-grid": {"categorical"},
    "ibc": {"negatives", "sampler"},
    "da-ibc": {"negatives", "sampler"},
    "ibc-langevin": {"negatives", "langevin_negatives", "sampler"},
    "diffusion": {"denoiser", "diffusion"},
    "flow": {"denoiser", "flow"},
}
_OF_ALL = {"method", "network", "density", "optimiser"}
_SAMPLERS = {"dfo", "grid", "langevin"}


def training_command(config: LearnerConfig, *, seed: int, data: Path) -> str:
    """Find the shortest call of `mjdrive train` that has all settings which the method uses.

    Args:
        config: The settings.
        seed: Of the run.
        data: Folder that the demonstrations will be in.
    """
    found = {
        name: _changes(presets.preset(name, config.method), config) for name in presets.PRESETS
    }
    preset = min(found, key=lambda name: (len(found[name]), name != "standard"))
    words = ["mjdrive", "train", config.method, "--data", str(data), "--seed", str(seed)]
    if preset != "standard":
        words += ["--preset", preset]
    for change in found[preset]:
        words += ["--set", change]
    return shlex.join(words)


def in_use(config: LearnerConfig) -> dict[str, str]:
    """Settings that have an effect on the method, by dotted name, as --set reads them."""
    sections = _OF_ALL | _SECTIONS[config.method]
    idle = tuple(f"sampler.{kind}." for kind in _SAMPLERS - {config.sampler.kind})
    flat = _flat(json.loads(serialization.to_json(config)))
    return {
        name: value
        for name, value in flat.items()
        if name.partition(".")[0] in sections and not name.startswith(idle)
    }


def _changes(preset: LearnerConfig, config: LearnerConfig) -> list[str]:
    """Settings that differ from a preset, as --set takes them."""
    before = _flat(json.loads(serialization.to_json(preset)))
    return [f"{name}={value}" for name, value in in_use(config).items() if value != before[name]]


def _flat(values: dict[str, Any], prefix: str = "") -> dict[str, str]:
    """Each setting as --set reads it, by its dotted name: a string without quotes, all else as JSON."""
    flat: dict[str, str] = {}
    for name, value in values.items():
        if isinstance(value, dict):
            flat |= _flat(value, f"{prefix}{name}.")
        else:
            flat[prefix + name] = value if isinstance(value, str) else json.dumps(value)
    return flat
