import dataclasses

import pytest

from models import config
from models.errors import SettingError
from models.presets import PRESETS, paper, preset
from models.serialization import from_json, to_json


@pytest.mark.parametrize(
    ("kind", "name", "value"),
    [
        (config.NetworkConfig, "state_dropout", 1.5),
        (config.NetworkConfig, "speed_scale", 0.0),
        (config.BetaConfig, "label_clamp", 0.0),
        (config.BetaConfig, "entropy_bonus", -0.1),
        (config.MixtureConfig, "components", 0),
        (config.CategoricalConfig, "points", 1),
        (config.CategoricalConfig, "smoothing", -0.1),
        (config.CategoricalConfig, "temperature", 0.0),
        (config.DenoiserConfig, "draws", 0),
        (config.DenoiserConfig, "noise_floor", 0.0),
        (config.DiffusionConfig, "steps", 0),
        (config.FlowConfig, "steps", 0),
        (config.NegativesConfig, "count", 0),
        (config.NegativesConfig, "sigma", -1.0),
        (config.NegativesConfig, "uniform_share", 2.0),
        (config.DensityConfig, "bandwidth", 0.0),
        (config.DensityConfig, "cap", 0.5),
        (config.DfoConfig, "iterations", 0),
        (config.DfoConfig, "shrink", 0.0),
        (config.DfoConfig, "bound", 1.1),
        (config.GridConfig, "points", 1),
        (config.GridConfig, "temperature", 0.0),
        (config.OptimiserConfig, "learning_rate", 0.0),
        (config.OptimiserConfig, "gradient_clip", 0.0),
        (config.OptimiserConfig, "validation_share", 1.0),
        (config.OptimiserConfig, "ema_decay", 1.0),
    ],
)
def test_a_setting_out_of_range_is_refused_by_name(kind, name, value):
    with pytest.raises(SettingError, match=f"^{name} is .*; expected"):
        kind(**{name: value})


def test_every_field_has_its_line_of_documentation():
    kinds = [
        kind for kind in vars(config).values() if str(kind).startswith("<class 'models.config")
    ]
    assert len(kinds) >= 12
    for kind in kinds:
        for field in dataclasses.fields(kind):
            assert f"        {field.name}: " in kind.__doc__, f"{kind.__name__}.{field.name}"


def test_the_paper_preset_has_the_numbers_of_the_paper():
    settings = paper("da-ibc")
    optimiser, search = settings.optimiser, settings.sampler.dfo
    assert (optimiser.learning_rate, optimiser.epochs, optimiser.batch_size) == (1e-5, 400, 128)
    assert optimiser.schedule == "constant"
    assert (search.num_samples, search.iterations) == (16384, 5)
    assert (search.sigma_init, search.shrink, search.choice) == (0.5, 0.5, "sample")
    assert (search.start, search.temper) == ("inverse_kde", False)
    assert settings.negatives.count == 1024
    assert (settings.density.bandwidth, settings.density.weighting) == (0.2, "sampler")
    assert settings.network.state_inputs == config.STATE_INPUTS
    assert (settings.beta.inference, settings.beta.beta_offset) == ("mode", 0)


@pytest.mark.parametrize("method", config.METHODS)
@pytest.mark.parametrize("name", PRESETS)
def test_presets_survive_json(name, method):
    settings = preset(name, method)
    assert settings.method == method
    assert from_json(to_json(settings)) == settings


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{", "Expected a JSON object"),
        (
            '{"method": "da-ibc", "lerning_rate": 1}',
            r"in settings, extra fields found \(lerning_rate\); expected method, .*optimiser\.$",
        ),
        ('{"method": "gail"}', "in settings.method, there is no 'gail'; expected bc-beta, .*flow"),
        ('{"method": "ibc", "commitment": 3}', "in settings.commitment, it is no JSON object"),
        (
            '{"method": "ibc", "commitment": {"hold": -1, "split": "x"}}',
            "in settings.commitment.split, 'x' is no float",
        ),
        (
            '{"method": "gail", "commitment": {"hold": -1}}',
            r"in settings.method, there .*; in settings.commitment, hold is -1; expected .*number\.$",
        ),
        ('{"method": "ibc", "negatives": {"count": "many"}}', "'many' is no int"),
        ('{"method": "ibc", "negatives": {"count": 2.5}}', "2.5 is no int"),
        ('{"method": "ibc", "negatives": {"clip": 1}}', "1 is no bool"),
        ('{"method": "ibc", "negatives": {"sigma": true}}', "True is no float"),
        ('{"method": "ibc", "negatives": {"sigma": -1}}', "sigma is -1"),
        ('{"method": "bc-beta", "beta": {"inference": "median"}}', "median"),
        ('{"method": "ibc", "network": {"state_inputs": ["velocity"]}}', "velocity"),
        ("[]", "Settings are a list"),
    ],
)
def test_settings_that_do_not_fit_are_refused_with_the_reason(text, reason):
    with pytest.raises(SettingError, match=reason):
        from_json(text)


def test_unknown_presets_and_methods_name_the_nearest():
    with pytest.raises(SettingError, match=r"Known: quick, standard, paper. Did you mean 'quick'"):
        preset("quik", "ibc")
    with pytest.raises(SettingError, match="Did you mean 'da-ibc'"):
        preset("quick", "da_ibc")
