import dataclasses

import pytest

from models.config import (
    METHODS,
    BetaConfig,
    LearnerConfig,
    Method,
    SamplerConfig,
    is_idle,
    settings_of,
)


def setting_names(config: object, prefix: str = "") -> list[str]:
    names: list[str] = []
    for field in dataclasses.fields(config):  # type: ignore[arg-type]
        value, name = getattr(config, field.name), f"{prefix}{field.name}"
        is_group = dataclasses.is_dataclass(value)
        names += setting_names(value, f"{name}.") if is_group else [name]
    return names


NAMES = setting_names(LearnerConfig("da-ibc"))


@pytest.mark.parametrize("name", NAMES)
def test_every_setting_has_an_effect_on_some_method(name: str) -> None:
    assert any(name.startswith(settings_of(method)) for method in METHODS)


@pytest.mark.parametrize("method", METHODS)
def test_all_that_is_said_to_have_an_effect_is_a_setting(method: Method) -> None:
    for start in settings_of(method):
        assert any(name.startswith(start) for name in NAMES), start


@pytest.mark.parametrize("kind", ["dfo", "grid", "langevin"])
def test_settings_of_the_other_samplers_lie_idle(kind: str) -> None:
    config = LearnerConfig("ibc", sampler=SamplerConfig(kind=kind))  # type: ignore[arg-type]
    used = [name for name in NAMES if name.startswith("sampler.") and not is_idle(name, config)]
    groups = {name.removeprefix("sampler.").partition(".")[0] for name in used}
    assert groups == {"kind", "undo", "precision", kind}


@pytest.mark.parametrize("method", ["bc-beta", "bc-mixture"])
@pytest.mark.parametrize("inference", ["mode", "mean", "sample"])
def test_chance_can_only_last_where_there_is_chance(method: Method, inference: str) -> None:
    config = LearnerConfig(method, beta=BetaConfig(inference=inference))  # type: ignore[arg-type]
    assert is_idle("commitment.hold", config) == (inference != "sample")
