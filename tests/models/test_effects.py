import dataclasses

import pytest

from models.config import (
    METHODS,
    BetaConfig,
    CategoricalConfig,
    CommitmentConfig,
    GridConfig,
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


CERTAIN = [
    *(LearnerConfig(it, beta=BetaConfig(inference="mode")) for it in ("bc-beta", "bc-mixture")),
    LearnerConfig("bc-beta", beta=BetaConfig(inference="mean")),
    LearnerConfig("bc-grid", categorical=CategoricalConfig(choice="argmax")),
    LearnerConfig("da-ibc", sampler=SamplerConfig(kind="grid", grid=GridConfig(choice="argmin"))),
    LearnerConfig("da-ibc", sampler=SamplerConfig(kind="dfo")),
]

SAMPLED = [
    *(LearnerConfig(it, beta=BetaConfig(inference="sample")) for it in ("bc-beta", "bc-mixture")),
    LearnerConfig("bc-grid", categorical=CategoricalConfig(choice="sample")),
    LearnerConfig("ibc", sampler=SamplerConfig(kind="grid", grid=GridConfig(choice="sample"))),
    LearnerConfig("diffusion"),
    LearnerConfig("flow"),
]


@pytest.mark.parametrize("config", CERTAIN)
def test_chance_cannot_last_where_nothing_is_drawn_from_a_density(config: LearnerConfig) -> None:
    assert is_idle("commitment.hold", config)


@pytest.mark.parametrize("config", SAMPLED)
def test_chance_can_last_where_actions_are_drawn_from_one(config: LearnerConfig) -> None:
    assert not is_idle("commitment.hold", config)


@pytest.mark.parametrize("hold", [0, 30])
def test_a_density_is_estimated_from_draws_only_where_chance_lasts(hold: int) -> None:
    config = LearnerConfig("flow", commitment=CommitmentConfig(hold=hold))
    assert is_idle("denoiser.candidates", config) == (hold == 0)
