import dataclasses
import math

import pytest
import torch

from models import undoing
from models.config import DensityConfig, LearnerConfig, NegativesConfig, SamplerConfig
from models.density import action_density, inverse_weights, kernel_density
from models.errors import SettingError
from models.expert_actions import ExpertActions
from models.negatives import log_density, uniform_actions

PLAIN = NegativesConfig(count=100, sigma=0.2, clip=False)
WEIGHED = DensityConfig(weighting="loss")


def settings(undo, *, negatives=PLAIN, density=WEIGHED):
    return LearnerConfig(
        "da-ibc", negatives=negatives, density=density, sampler=SamplerConfig(undo=undo)
    )


@pytest.fixture
def demonstrated(generator):
    """Expert actions that crowd around going straight on, and reach into a corner."""
    straight = torch.randn(250, 2, generator=generator) * 0.1
    corner = torch.tensor([-0.9, 0.8]) + 0.1 * torch.randn(50, 2, generator=generator)
    return torch.cat((straight, corner)).clamp(-1, 1)


@pytest.fixture
def anywhere(generator):
    return uniform_actions(2, 500, generator=generator)


def tilt_of(config, demonstrated, actions):
    experts = ExpertActions()
    experts.remember(demonstrated, action_density(demonstrated, config.density))
    return experts.tilt(config, actions)


@pytest.mark.parametrize("sigma", [0.05, 0.2])
@pytest.mark.parametrize("uniform_share", [0.0, 0.25, 1.0])
def test_undoing_negatives_adds_the_log_of_their_density(
    sigma, uniform_share, demonstrated, anywhere
):
    negatives = dataclasses.replace(PLAIN, sigma=sigma, uniform_share=uniform_share)
    config = settings("negatives", negatives=negatives)
    expected = log_density(anywhere, demonstrated, negatives)
    found = tilt_of(config, demonstrated, anywhere)[0]
    # Where there are hardly any negatives, nothing hangs on how few exactly.
    counts = expected > -20
    assert counts.float().mean() > 0.2
    torch.testing.assert_close(found[counts], expected[counts], rtol=0, atol=0.02)


def test_negatives_of_minibatches_that_were_drawn_by_weight_are_weighed_too(demonstrated, anywhere):
    density = DensityConfig(weighting="sampler")
    weights = inverse_weights(action_density(demonstrated, density), density)
    chosen = torch.multinomial(
        weights, 40_000, replacement=True, generator=torch.Generator().manual_seed(0)
    )
    found = tilt_of(settings("negatives", density=density), demonstrated, anywhere)[0]
    expected = log_density(anywhere, demonstrated[chosen], PLAIN)
    counts = expected > -6
    torch.testing.assert_close(found[counts], expected[counts], rtol=0, atol=0.1)
    from_all = settings(
        "negatives", density=density, negatives=dataclasses.replace(PLAIN, pool="dataset")
    )
    found = tilt_of(from_all, demonstrated, anywhere)[0]
    expected = log_density(anywhere, demonstrated, PLAIN)
    torch.testing.assert_close(found[counts], expected[counts], rtol=0, atol=0.02)


@pytest.mark.parametrize("kind", ["joint", "product"])
@pytest.mark.parametrize(("exponent", "cap"), [(1.0, None), (0.5, None), (1.0, 4.0)])
def test_undoing_weights_takes_out_what_demonstrations_were_weighed_by(
    kind, exponent, cap, demonstrated
):
    density = DensityConfig(weighting="loss", kind=kind, exponent=exponent, cap=cap)
    weights = inverse_weights(action_density(demonstrated, density), density)
    found = tilt_of(settings("density", density=density), demonstrated, demonstrated[None])[0, 0]
    sums = weights.log() + found
    torch.testing.assert_close(sums, sums.mean().expand_as(sums), rtol=0, atol=0.01)


def test_undoing_both_is_the_sum(demonstrated, anywhere):
    one, other, both = (
        tilt_of(settings(undo), demonstrated, anywhere)[0]
        for undo in ("negatives", "density", "both")
    )
    torch.testing.assert_close(both, one + other, rtol=0, atol=0.01)


def test_slopes_are_those_of_what_is_added(demonstrated, anywhere):
    config, step = settings("both"), 0.01
    inside = 0.9 * anywhere
    slopes = tilt_of(config, demonstrated, inside)[1:]
    for axis in range(2):
        shift = step * torch.eye(2)[axis]
        high, low = (tilt_of(config, demonstrated, inside + sign * shift)[0] for sign in (1, -1))
        torch.testing.assert_close(slopes[axis], (high - low) / (2 * step), rtol=0.02, atol=0.1)


def test_a_checkpoint_and_other_settings_make_the_surface_anew(demonstrated, anywhere):
    config = settings("density")
    experts = ExpertActions()
    experts.remember(demonstrated, action_density(demonstrated, config.density))
    first = experts.tilt(config, anywhere)
    milder = settings("density", density=dataclasses.replace(WEIGHED, exponent=0.5))
    assert not torch.equal(experts.tilt(milder, anywhere), first)
    assert torch.equal(experts.tilt(config, anywhere), first)
    others = ExpertActions()
    others.remember(-demonstrated, action_density(-demonstrated, config.density))
    experts.load_state_dict(others.state_dict())
    assert torch.equal(experts.tilt(config, anywhere), others.tilt(config, anywhere))
    assert set(experts.state_dict()) == {"actions", "density"}


def test_the_lattice_is_finer_than_the_kernels_and_bounded(demonstrated):
    points = {}
    for sigma in (0.2, 0.1, 1e-3):
        config = settings("negatives", negatives=dataclasses.replace(PLAIN, sigma=sigma))
        density = action_density(demonstrated, config.density)
        points[sigma] = undoing.surface(config, demonstrated, density).shape[-1]
    assert points == {0.2: 161, 0.1: 321, 1e-3: undoing.MOST_POINTS}


def test_far_from_every_demonstration_all_stays_finite():
    config = settings("both", negatives=dataclasses.replace(PLAIN, sigma=0.01))
    one = torch.tensor([[-1.0, -1.0]])
    surface = undoing.surface(config, one, kernel_density(one, one, bandwidth=0.2, kind="joint"))
    assert torch.isfinite(surface).all()
    assert math.isclose(surface[0].min(), math.log(undoing.LEAST_DENSITY), rel_tol=0.2)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        (
            {"negatives": dataclasses.replace(PLAIN, correction="ranking")},
            "corrected for them already",
        ),
        ({"negatives": dataclasses.replace(PLAIN, clip=True)}, "no density"),
        ({"negatives": dataclasses.replace(PLAIN, sigma=0.0)}, "no density"),
        ({"method": "ibc"}, "uniform and tilt nothing"),
        ({"method": "ibc-langevin"}, "no negatives whose density is known; expected da-ibc"),
        ({"method": "bc-beta"}, "does not remember the demonstrations.*expected one of ibc"),
        ({"density": DensityConfig(weighting="none")}, "no weights tilted.*undo=negatives"),
    ],
)
def test_what_cannot_be_undone_or_would_be_twice_is_refused(changes, reason):
    good = settings("both")
    with pytest.raises(SettingError, match=rf"^sampler.undo is 'both', but .*{reason}"):
        dataclasses.replace(good, **changes)


def test_weights_can_be_undone_for_every_energy():
    for method in ("ibc", "da-ibc", "ibc-langevin"):
        dataclasses.replace(settings("density"), method=method)


def test_weights_are_taken_out_of_any_density_as_out_of_an_energy(demonstrated, anywhere):
    config = settings("density")
    said = torch.zeros(2, 500)
    found = undoing.without_weights(
        said, anywhere, settings=config.density, demonstrated=demonstrated
    )
    torch.testing.assert_close(found, tilt_of(config, demonstrated, anywhere)[0])
