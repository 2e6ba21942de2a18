"""Settings of training runs and of their driving, from what the command line says."""

import json
from collections.abc import Iterable
from typing import Any

from mjdrive.errors import ConfigError, UnknownNameError
from models import presets, serialization
from models.config import LearnerConfig, is_idle
from models.errors import SettingError

ACTING = (
    "sampler.",
    "commitment.",
    "beta.inference",
    "categorical.choice",
    "categorical.temperature",
    "diffusion.sampler",
    "diffusion.steps",
    "diffusion.clip",
    "flow.",
    "denoiser.noise_floor",
    "denoiser.density_steps",
    "denoiser.candidates",
)
"""How the names of settings begin that a trained policy can change."""


def learner_settings(
    method: str, *, preset: str = "standard", assignments: Iterable[str] = ()
) -> LearnerConfig:
    """Choose the settings of a training run.

    Args:
        method: One of `models.config.METHODS`.
        preset: "quick", "standard" or "paper".
        assignments: Changes to the preset, each as "optimiser.learning_rate=1e-4".

    Returns:
        The checked settings.

    Raises:
        ConfigError: If a method, preset or value is not one of those expected.
        UnknownNameError: If there is no such setting.
    """
    try:
        config = presets.preset(preset, method)
    except SettingError as error:
        raise ConfigError(str(error)) from error
    return changed(config, assignments)


def changed(config: LearnerConfig, assignments: Iterable[str]) -> LearnerConfig:
    """Change some settings.

    Args:
        config: Settings to begin with.
        assignments: Changes, each as "optimiser.learning_rate=1e-4".

    Returns:
        The checked settings.

    Raises:
        ConfigError: If a value is not one of those expected.
        UnknownNameError: If there is no such setting.
    """
    values = json.loads(serialization.to_json(config))
    try:
        for assignment in assignments:
            _assign(values, assignment)
        return serialization.from_json(json.dumps(values))
    except SettingError as error:
        raise ConfigError(str(error)) from error


def acting_changed(config: LearnerConfig, assignments: Iterable[str]) -> LearnerConfig:
    """Let a trained policy choose its actions in another way; what it has learnt stays.

    Args:
        config: Settings that the policy was trained with.
        assignments: Changes, each as "sampler.kind=grid".

    Raises:
        ConfigError: If a setting decides what is learnt or has no effect on the policy, or a value is not one of those expected.
        UnknownNameError: If there is no such setting.
    """
    assignments = tuple(assignments)
    after = changed(config, assignments)
    learnt = [it for it in assignments if not it.startswith(ACTING)]
    if learnt:
        raise ConfigError(
            f"'{learnt[0]}' decides what is learnt, not how a trained policy acts. Expected settings that begin with "
            f"{', '.join(ACTING)}; train another policy with it."
        )
    idle = [it for it in assignments if is_idle(it.partition("=")[0], after)]
    if idle:
        raise ConfigError(
            f"'{idle[0]}' has no effect on a policy of {config.method} that acts as this one does. Leave it out, or change how it acts as well."
        )
    return after


def acting_settings(config: LearnerConfig, *, preset: str) -> LearnerConfig:
    """Let a trained policy choose its actions as a preset does; what it has learnt stays.

    Args:
        config: Settings that the policy was trained with.
        preset: "quick", "standard" or "paper".

    Returns:
        The same settings with the sampler and the inference of the preset.

    Raises:
        ConfigError: If there is no such preset.
    """
    other = learner_settings(config.method, preset=preset)
    values = json.loads(serialization.to_json(other))
    paths = [path for path in _leaves(values, "") if path.startswith(ACTING)]
    return changed(config, (f"{path}={json.dumps(_at(values, path))}" for path in paths))


def _at(values: dict[str, Any], path: str) -> Any:
    """What nested settings hold at a dotted name."""
    for name in path.split("."):
        values = values[name]
    return values


def _assign(values: dict[str, Any], assignment: str) -> None:
    """Change one value in nested settings."""
    path, equals, text = assignment.partition("=")
    names = path.split(".")
    if not equals or names == ["method"]:
        raise ConfigError(
            f"Cannot set '{assignment}'. Expected a name and a value, as in optimiser.learning_rate=1e-4."
        )
    for depth, name in enumerate(names):
        if not isinstance(values, dict) or name not in values:
            known = _leaves(values, ".".join([*names[:depth], ""]))
            raise UnknownNameError("setting", path, known)
        if depth < len(names) - 1:
            values = values[name]
    if isinstance(values[names[-1]], dict):
        raise UnknownNameError("setting", path, _leaves(values[names[-1]], f"{path}."))
    values[names[-1]] = _value(text)


def _leaves(values: Any, prefix: str) -> list[str]:
    """Dotted names of everything that can be set below a prefix."""
    if not isinstance(values, dict):
        return [prefix.removesuffix(".")]
    return [leaf for name, value in values.items() for leaf in _leaves(value, f"{prefix}{name}.")]


def _value(text: str) -> Any:
    """Read a value as JSON; what is no JSON is a string, so that names need no quotes."""
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return text
