import pytest

from mjdrive.errors import ConfigError, UnknownNameError
from mjdrive.learning.settings import acting_settings, learner_settings
from models import presets
from models.config import METHODS


def test_without_assignments_it_is_the_preset() -> None:
    assert learner_settings("ibc", preset="paper") == presets.paper("ibc")


def test_assignments_change_nested_settings_and_nothing_else() -> None:
    changed = learner_settings(
        "da-ibc",
        assignments=("optimiser.learning_rate=1e-4", "sampler.kind=dfo", "density.cap=null"),
    )
    assert changed.optimiser.learning_rate == 1e-4
    assert changed.sampler.kind == "dfo"
    assert changed.density.cap is None
    assert changed.network == presets.standard("da-ibc").network


@pytest.mark.parametrize(
    ("assignment", "message"),
    [
        ("optimizer.epochs=3", "Did you mean 'optimiser.epochs'"),
        ("optimiser=3", "Known: optimiser.batch_size"),
        ("optimiser.epochs.more=3", "Unknown setting"),
    ],
)
def test_unknown_settings_are_refused(assignment: str, message: str) -> None:
    with pytest.raises(UnknownNameError, match=message):
        learner_settings("ibc", assignments=(assignment,))


@pytest.mark.parametrize(
    ("assignment", "message"),
    [
        ("optimiser.epochs", "Expected a name and a value"),
        ("method=ibc", "Cannot set 'method=ibc'"),
        ("optimiser.epochs=many", "'many' is no int"),
        ("optimiser.epochs=0", "epochs is 0; expected"),
    ],
)
def test_bad_values_are_refused(assignment: str, message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        learner_settings("ibc", assignments=(assignment,))


def test_unknown_method_and_preset_are_refused() -> None:
    with pytest.raises(ConfigError, match="Unknown method 'bc'"):
        learner_settings("bc")
    with pytest.raises(ConfigError, match="Unknown preset 'fast'"):
        learner_settings("ibc", preset="fast")


@pytest.mark.parametrize("method", METHODS)
def test_acting_as_a_preset_changes_nothing_that_is_learnt(method: str) -> None:
    trained = learner_settings(
        method,
        assignments=(
            "categorical.points=9",
            "categorical.choice=argmax",
            "diffusion.prediction=epsilon",
            "diffusion.steps=3",
            "flow.steps=2",
            "beta.label_noise=0.3",
            "sampler.grid.points=5",
        ),
    )
    expected = learner_settings(
        method,
        assignments=(
            "categorical.points=9",
            "diffusion.prediction=epsilon",
            "beta.label_noise=0.3",
        ),
    )
    assert acting_settings(trained, preset="standard") == expected
