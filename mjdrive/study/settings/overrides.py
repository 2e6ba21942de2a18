"""What the command line changes of a study."""

import dataclasses
import json
from collections.abc import Iterable, Sequence

from mjdrive import config
from mjdrive.config import Arm, StudyConfig, Variant
from mjdrive.config.study import names_of
from mjdrive.errors import ConfigError, UnknownNameError
from mjdrive.study.settings import presets

FIXED = ("preset", "variants", "arms", "demonstrations", "references")
"""Settings of a study that --set does not reach."""


def chosen(
    preset: str,
    *,
    methods: Sequence[str] | None = None,
    seeds: Sequence[int] | None = None,
    episodes: int | None = None,
    steps: int | None = None,
    assignments: Iterable[str] = (),
    ablations: bool = True,
    arms: Sequence[str] | None = None,
) -> StudyConfig:
    """Change a preset; what is None stays as it is there.

    Args:
        preset: Name of the preset.
        methods: What is compared.
        seeds: Training seeds of all methods; seeds of ablations and details that are not among them are left out [-].
        episodes: Drives of each agent in each of its ways to act [-].
        steps: Control steps of each of them [-].
        assignments: Other changes, each as "long_steps=0" for the study, "optimiser.epochs=5" for every learner or
            "da-ibc:optimiser.epochs=5" for those of a method. With "seeds=[4,5]" it is as with `seeds`.
        ablations: Whether the ablations of the preset are kept.
        arms: Names of the ways to act that are kept; what acts in none of them is not trained.

    Raises:
        ConfigError: If a value is out of its range.
        UnknownNameError: If there is no such preset, method, arm or setting.
    """
    study = presets.preset(preset, methods=methods)
    if arms is not None:
        study = presets.with_asked_for(study, arms)
    if not ablations:
        study = _without_ablations(study)
    if arms is not None:
        study = _with_arms(study, arms)
    numbers = {"episodes": episodes, "steps": steps, "seeds": seeds}
    values: dict[str, object] = {name: it for name, it in numbers.items() if it is not None}
    for assignment in assignments:
        name, equals, text = assignment.partition("=")
        if not equals:
            raise ConfigError(
                f"Cannot set '{assignment}'. Expected a name and a value, as in long_steps=0 or optimiser.epochs=5."
            )
        if "." in name:
            study = _with_learners(study, name, text)
        else:
            values[_known(name)] = _value(text)
    wanted = values.get("seeds")
    if isinstance(wanted, Sequence) and not isinstance(wanted, str):
        values = _some_of(study, wanted) | values
        study = _with_all_seeds(study)
    plain = json.loads(config.to_json(study)) | values
    return config.from_dict(StudyConfig, plain)


def _without_ablations(config: StudyConfig) -> StudyConfig:
    """The same study of the methods alone."""
    methods = {it.name for it in config.variants if not it.change}
    kept = [
        dataclasses.replace(it, as_ablation="")
        for it in config.arms
        if it.variant in methods and not it.change
    ]
    return _acting_in(config, kept)


def _with_all_seeds(config: StudyConfig) -> StudyConfig:
    """The same study with an agent for each method and seed."""
    variants = tuple(dataclasses.replace(it, all_seeds=True) for it in config.variants)
    return dataclasses.replace(config, variants=variants)


def _with_arms(config: StudyConfig, names: Sequence[str]) -> StudyConfig:
    """The same study of some ways to act; what acts in none of them is not trained.

    Args:
        config: The study.
        names: Of the arms that are kept.

    Raises:
        UnknownNameError: If it has no such arm.
    """
    known = names_of(config.arms)
    for name in names:
        if name not in known:
            raise UnknownNameError("arm of this study", name, known)
    return _acting_in(config, [it for it in config.arms if it.name in names])


def _acting_in(config: StudyConfig, arms: Sequence[Arm]) -> StudyConfig:
    """The same study with some of its arms, and what they need."""
    acting = {it.variant for it in arms}
    variants = tuple(it for it in config.variants if it.name in acting)
    learnt = {it.demonstrations for it in variants}
    return dataclasses.replace(
        config,
        variants=variants,
        arms=tuple(arms),
        demonstrations=tuple(it for it in config.demonstrations if it.name in learnt),
    )


def _some_of(study: StudyConfig, seeds: Sequence[int]) -> dict[str, object]:
    """Seeds of ablations and details that go with seeds of methods."""
    return {
        "ablation_seeds": _among(study.ablation_seeds, seeds),
        "detail_seeds": _among(study.detail_seeds, seeds),
    }


def _among(wanted: Sequence[int], seeds: Sequence[int]) -> tuple[int, ...]:
    """Those of some seeds that there are; the first one there is if there are none, but there should be."""
    found = tuple(seed for seed in wanted if seed in seeds)
    return found or (tuple(seeds[:1]) if wanted else ())


def _known(name: str) -> str:
    names = [it.name for it in dataclasses.fields(StudyConfig) if it.name not in FIXED]
    if name not in names:
        raise UnknownNameError("setting of a study", name, names)
    return name


def _with_learners(study: StudyConfig, name: str, text: str) -> StudyConfig:
    """Change a setting of the learners of a method, or of all; what an ablation changes goes before."""
    method, colon, setting = name.rpartition(":")
    methods = {variant.method for variant in study.variants}
    if colon and method not in methods:
        raise UnknownNameError("method of this study", method, methods)

    def changed(variant: Variant) -> Variant:
        if colon and variant.method != method:
            return variant
        own, new = variant.assignments, (f"{setting}={text}",)
        return dataclasses.replace(
            variant, assignments=(*new, *own) if variant.change else (*own, *new)
        )

    return dataclasses.replace(study, variants=tuple(changed(it) for it in study.variants))


def _value(text: str) -> object:
    """Read a value as JSON; what is no JSON is a string, which only some settings take."""
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return text
