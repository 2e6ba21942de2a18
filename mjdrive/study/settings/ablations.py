"""What single settings of DA-IBC are worth: each ablation changes one thing, and says what.

Ways to act are changed with the study's DA-IBC. What is trained anew learns for a quarter as long, a few minutes instead
of most of an hour, and so does the DA-IBC that it is compared with.
"""

import dataclasses

from mjdrive.config import Arm, Demonstrations, Variant

WALKED_KM = 400.0
"""What agents of a standard study learn from: 56 times the ten routes, by random walks [km].

Enough to see each pair once; a quarter of them, seen four times, seems to be learnt by heart (docs/notes.md).
"""

UNDISTURBED = Demonstrations("undisturbed", preset="paper")
"""Demonstrations without disturbances, as the paper's."""

ABLATED_DEMONSTRATIONS = (
    dataclasses.replace(UNDISTURBED, random_walk_km=WALKED_KM),
    Demonstrations("routes"),
)
"""What ablations learn from instead of the study's own demonstrations."""

LONG = ("optimiser.epochs=4", "optimiser.epochs_per_pass=4", "optimiser.batch_size=64")
"""How long agents of a standard study learn: one pass of some 19,000 steps, nine times those of a standard run on ten routes."""

LONG_STEEP = (*LONG, "optimiser.learning_rate=6e-4")
"""The same for methods with a large step size, which smaller minibatches make smaller."""

_QUARTER = (*LONG_STEEP, "optimiser.epochs=1")
"""How long ablations learn: a random quarter of that pass, with a schedule of its own."""

DFO = (
    "sampler.kind=dfo",
    "sampler.dfo.num_samples=16384",
    "sampler.dfo.iterations=5",
    "sampler.dfo.sigma_init=0.5",
    "sampler.dfo.shrink=0.5",
    "sampler.dfo.start=inverse_kde",
)
"""As large a search as the paper's."""

PAPERS_DFO = (*DFO, "sampler.dfo.temper=false", "sampler.dfo.choice=sample")
"""How the paper acts."""

ANEW, COMMITTED = "commitment.hold=0", "commitment.hold=30"
"""Draw each action anew, or let the chance of steering last for three seconds."""

GRID_SAMPLED = ("sampler.kind=grid", "sampler.grid.choice=sample", ANEW)
GRID_COMMITTED = ("sampler.kind=grid", "sampler.grid.choice=sample", COMMITTED)
GRID_LOWEST = ("sampler.kind=grid", "sampler.grid.choice=argmin")

_PAPERS_NEGATIVES = (
    "negatives.correction=none",
    "negatives.uniform_share=0",
    "negatives.clip=true",
    "negatives.sigma=0.22",
)

_SEES_ACTION = 'network.state_inputs=["speed", "previous_acceleration", "previous_steering"]'


QUARTER = Variant(
    "da-ibc-quarter",
    "da-ibc",
    assignments=_QUARTER,
    change="trained for a quarter of the pass",
    base="da-ibc",
)
"""What ablations of training change: DA-IBC that has learnt as long as they have."""


def _variant(
    name: str, change: str, *assignments: str, demonstrations: str = "demonstrations"
) -> Variant:
    return Variant(
        f"da-ibc-{name}",
        "da-ibc",
        assignments=(*_QUARTER, *assignments),
        demonstrations=demonstrations,
        change=change,
        base=QUARTER.name,
    )


ABLATIONS = (
    QUARTER,
    _variant("uncorrected", "no ranking correction", "negatives.correction=none"),
    _variant(
        "papers-negatives",
        "the paper's negatives: around expert actions alone, clipped, not corrected for",
        *_PAPERS_NEGATIVES,
    ),
    _variant("kde-sampler", "pairs drawn by 1/KDE, as the paper does", "density.weighting=sampler"),
    _variant("kde-loss", "losses weighed by 1/KDE, as the paper writes", "density.weighting=loss"),
    _variant("previous-action", "sees its previous action", _SEES_ACTION),
    _variant(
        "previous-action-dropped",
        "sees its previous action, in training half of the time",
        _SEES_ACTION,
        "network.state_dropout=0.5",
    ),
    _variant("lights-now", "sees the lights of now alone", "network.light_history=false"),
    _variant("plain-head", "plain first weights of the action", "network.action_gain=1"),
    _variant("averaged", "acts by a running mean of its weights", "optimiser.ema_decay=0.999"),
    _variant("undisturbed", "undisturbed demonstrations", demonstrations="undisturbed"),
    _variant(
        "perturbed",
        "undisturbed demonstrations, half of the pairs seen from perturbed poses",
        "perturbation.share=0.5",
        demonstrations="undisturbed",
    ),
    _variant(
        "routes",
        "the ten routes thirteen times, instead of a quarter of 400 km of random walks",
        "optimiser.epochs=13",
        "optimiser.epochs_per_pass=1",
        demonstrations="routes",
    ),
    _variant(
        "papers",
        "all of the paper's choices, but for its optimiser",
        *_PAPERS_NEGATIVES,
        "negatives.count=1024",
        "density.weighting=sampler",
        _SEES_ACTION,
        "network.speed_scale=1",
        "network.action_gain=1",
        demonstrations="undisturbed",
    ),
)
"""Trained anew, with a single change, of which the paper's negatives are four settings, and at last with all of the paper's choices together.

Its optimiser, 400 passes over the ten routes, takes seven hours an agent: that is for the preset `paper`.
"""


def _arm(name: str, variant: str, label: str, change: str, *acting: str) -> Arm:
    return Arm(f"da-ibc-{name}", variant, f"DA-IBC, {label}", (*GRID_COMMITTED, *acting), change)


ACTING_ABLATIONS: tuple[Arm, ...] = (
    *(Arm(it.name, it.name, f"DA-IBC, {it.change}", GRID_COMMITTED, it.change) for it in ABLATIONS),
    _arm(
        "uncorrected-undone",
        "da-ibc-uncorrected",
        "corrected when it acts",
        "no ranking correction in training, but when it acts",
        "sampler.undo=negatives",
    ),
    _arm(
        "kde-sampler-undone",
        "da-ibc-kde-sampler",
        "1/KDE undone",
        "pairs drawn by 1/KDE, undone when it acts",
        "sampler.undo=density",
    ),
    Arm(
        "da-ibc-papers-dfo",
        "da-ibc-papers",
        "DA-IBC, as the paper's",
        PAPERS_DFO,
        "all of the paper's choices, its DFO too, but for its optimiser",
    ),
    _arm(
        "brief",
        "da-ibc",
        "committed for 1 s",
        "the chance of steering lasts for a second",
        "commitment.hold=10",
    ),
    _arm(
        "hasty",
        "da-ibc",
        "turns given up below 5 %",
        "a turn is given up where it has less than 5 % of the distribution, not 0.1 %",
        "commitment.release=0.05",
    ),
    _arm(
        "cold",
        "da-ibc",
        "half temperature",
        "sampled from half the temperature",
        "sampler.grid.temperature=0.5",
    ),
    Arm(
        "da-ibc-tempered-argmin",
        "da-ibc",
        "DA-IBC, tempered DFO lowest",
        (
            "sampler.kind=dfo",
            "sampler.dfo.num_samples=2048",
            "sampler.dfo.temper=true",
            "sampler.dfo.choice=argmin",
        ),
        "the lowest energy that the tempered DFO finds",
    ),
)
"""Ways to act: of the agents above, and of the study's DA-IBC with a single change."""

KDE = Variant(
    "da-ibc-kde",
    "da-ibc",
    assignments=(*LONG_STEEP, "density.weighting=sampler"),
    change="pairs drawn by 1/KDE, for the whole pass",
    base="da-ibc",
    like_methods=True,
)
"""DA-IBC that sees rare actions more often, trained as long and with as many seeds as the study's."""

KDE_ARMS = (
    Arm("da-ibc-kde-committed", KDE.name, "DA-IBC by 1/KDE, grid committed", GRID_COMMITTED),
    Arm(
        "da-ibc-kde-sample",
        KDE.name,
        "DA-IBC by 1/KDE, grid sampled",
        GRID_SAMPLED,
        as_ablation=f"{KDE.change}, and each action drawn anew",
    ),
    Arm(
        "da-ibc-kde-argmin",
        KDE.name,
        "DA-IBC by 1/KDE, grid lowest",
        GRID_LOWEST,
        as_ablation=f"{KDE.change}, and the lowest energy",
    ),
)
"""How it acts: as the study's DA-IBC does. It is there if it is asked for by name: with it, a study takes longer than a night."""
