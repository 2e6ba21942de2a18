"""Named studies: `quick` takes minutes, `standard` a night on two cores, `paper` has the settings of the paper throughout."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from mjdrive.config import Arm, Demonstrations, StudyConfig, Variant
from mjdrive.config.study import names_of
from mjdrive.errors import UnknownNameError
from mjdrive.study.settings.ablations import (
    ABLATED_DEMONSTRATIONS,
    ABLATIONS,
    ACTING_ABLATIONS,
    ANEW,
    COMMITTED,
    DFO,
    GRID_COMMITTED,
    GRID_LOWEST,
    GRID_SAMPLED,
    KDE,
    KDE_ARMS,
    LONG,
    LONG_STEEP,
    PAPERS_DFO,
    UNDISTURBED,
    WALKED_KM,
)
from models.config import METHODS

COMPARED = ("bc-beta", "da-ibc")
"""Methods that a standard study trains with every seed, if none is asked for: an energy, and a likelihood of one mode."""

_GENTLE = ("bc-beta", "bc-mixture")
"""Methods whose step size is small anyway."""

_TEMPERED_DFO = (
    *DFO,
    "sampler.dfo.num_samples=2048",
    "sampler.dfo.temper=true",
    "sampler.dfo.choice=sample",
)


def _aside(name: str, variant: str, label: str, *acting: str) -> Arm:
    """A way to act that is looked at with one agent."""
    return Arm(name, variant, label, acting, all_seeds=False)


ARMS = (
    Arm("bc-beta-mode", "bc-beta", "BC-Beta, mode", ("beta.inference=mode",)),
    Arm("bc-beta-sample", "bc-beta", "BC-Beta, sampled", ("beta.inference=sample", ANEW)),
    Arm(
        "bc-beta-committed",
        "bc-beta",
        "BC-Beta, committed",
        ("beta.inference=sample", COMMITTED),
        is_long=True,
    ),
    _aside("bc-beta-mean", "bc-beta", "BC-Beta, mean", "beta.inference=mean"),
    Arm(
        "bc-mixture-committed",
        "bc-mixture",
        "BC mixture, committed",
        ("beta.inference=sample", COMMITTED),
    ),
    Arm("bc-mixture-sample", "bc-mixture", "BC mixture, sampled", ("beta.inference=sample", ANEW)),
    _aside("bc-mixture-mode", "bc-mixture", "BC mixture, mode", "beta.inference=mode"),
    Arm(
        "bc-grid-committed",
        "bc-grid",
        "BC grid, committed",
        ("categorical.choice=sample", COMMITTED),
    ),
    Arm("bc-grid-sample", "bc-grid", "BC grid, sampled", ("categorical.choice=sample", ANEW)),
    _aside("bc-grid-argmax", "bc-grid", "BC grid, densest", "categorical.choice=argmax"),
    Arm("ibc-committed", "ibc", "IBC, grid committed", GRID_COMMITTED),
    _aside("ibc-sample", "ibc", "IBC, grid sampled", *GRID_SAMPLED),
    _aside("ibc-argmin", "ibc", "IBC, grid lowest", *GRID_LOWEST),
    Arm("da-ibc-committed", "da-ibc", "DA-IBC, grid committed", GRID_COMMITTED),
    Arm(
        "da-ibc-sample",
        "da-ibc",
        "DA-IBC, grid sampled",
        GRID_SAMPLED,
        as_ablation="no commitment: each action is drawn anew",
    ),
    Arm("da-ibc-argmin", "da-ibc", "DA-IBC, grid lowest", GRID_LOWEST),
    _aside("da-ibc-dfo", "da-ibc", "DA-IBC, the paper's DFO", *PAPERS_DFO),
    _aside("da-ibc-tempered", "da-ibc", "DA-IBC, tempered DFO", *_TEMPERED_DFO),
    Arm("ibc-langevin-committed", "ibc-langevin", "Langevin IBC, grid committed", GRID_COMMITTED),
    Arm("ibc-langevin-chain", "ibc-langevin", "Langevin IBC, chains", ("sampler.kind=langevin",)),
    Arm("diffusion-committed", "diffusion", "Diffusion, committed", (COMMITTED,)),
    Arm("diffusion-sample", "diffusion", "Diffusion, sampled", (ANEW,)),
    Arm("flow-committed", "flow", "Flow matching, committed", (COMMITTED,)),
    Arm("flow-sample", "flow", "Flow matching, sampled", (ANEW,)),
)
"""How each method acts; the first of a method is its main way, but BC-Beta, whose mode is the paper's, makes the long drive in two. BC-Beta and DA-IBC
by mode and by sample are the 2 x 2 control; what is committed as well says what lasting chance does in either."""

_PAPER_ARMS = (
    Arm("bc-beta-mode", "bc-beta", "BC-Beta, mode", ("beta.inference=mode",)),
    Arm("bc-beta-sample", "bc-beta", "BC-Beta, sampled", ("beta.inference=sample", ANEW)),
    Arm("ibc-dfo", "ibc", "IBC, the paper's DFO", PAPERS_DFO),
    Arm("da-ibc-dfo", "da-ibc", "DA-IBC, the paper's DFO", PAPERS_DFO),
    Arm(
        "da-ibc-dfo-argmin",
        "da-ibc",
        "DA-IBC, DFO lowest",
        (*DFO, "sampler.dfo.temper=false", "sampler.dfo.choice=argmin"),
    ),
)


def quick(methods: Sequence[str] | None = None) -> StudyConfig:
    """A study of minutes: it shows that everything works, and nothing of what methods are worth."""
    methods = ("bc-beta", "da-ibc") if methods is None else methods
    variants = tuple(
        Variant(name, name, preset="quick", assignments=("optimiser.epochs=2",)) for name in methods
    )
    main = {arm.variant: arm for arm in reversed(ARMS)}
    return StudyConfig(
        preset="quick",
        variants=variants,
        arms=tuple(main[name] for name in methods),
        demonstrations=(Demonstrations("demonstrations", routes=("route0",)),),
        expert_walks=2,
        seeds=(0,),
        episodes=2,
        steps=200,
        long_steps=400,
        progress_every=1,
        progress_episodes=1,
        progress_steps=100,
        forks=1,
        fork_rollouts=4,
        held_out_km=0.2,
        held_out_frames=32,
    )


def standard(methods: Sequence[str] | None = None) -> StudyConfig:
    """Every method with the settings that drive best, and what each setting of DA-IBC is worth.

    Three agents of each method that is asked for; if none is, of the two that the question is about, and one of each
    other, as more would take longer than a night.
    """
    thorough = COMPARED if methods is None else methods
    methods = METHODS if methods is None else methods
    ablated = "da-ibc" in methods
    return StudyConfig(
        preset="standard",
        variants=(
            *(
                Variant(
                    name,
                    name,
                    assignments=LONG if name in _GENTLE else LONG_STEEP,
                    all_seeds=name in thorough,
                )
                for name in methods
            ),
            *(ABLATIONS if ablated else ()),
        ),
        arms=(
            *(arm for name in methods for arm in ARMS if arm.variant == name),
            *(ACTING_ABLATIONS if ablated else ()),
        ),
        demonstrations=(
            Demonstrations("demonstrations", random_walk_km=WALKED_KM),
            *(ABLATED_DEMONSTRATIONS if ablated else ()),
        ),
        long_steps=70_000,
        progress_every=1,
        forks=1,
    )


def with_asked_for(study: StudyConfig, arms: Sequence[str]) -> StudyConfig:
    """Add what a standard study of DA-IBC has only if it is asked for by name.

    Args:
        study: Any study.
        arms: Names of ways to act.
    """
    is_standard = study.preset == "standard" and "da-ibc" in names_of(study.variants)
    if not is_standard or not {it.name for it in KDE_ARMS} & set(arms):
        return study
    return replace(study, variants=(*study.variants, KDE), arms=(*study.arms, *KDE_ARMS))


def paper(methods: Sequence[str] | None = None) -> StudyConfig:
    """The paper: three agents of each of its methods, ten episodes of 3,000 steps every ten epochs, its settings throughout."""
    methods = ("bc-beta", "ibc", "da-ibc") if methods is None else methods
    mine = {arm.variant for arm in _PAPER_ARMS}
    arms = (*_PAPER_ARMS, *(arm for arm in ARMS if arm.variant not in mine))
    return StudyConfig(
        preset="paper",
        variants=tuple(
            Variant(name, name, preset="paper", demonstrations=UNDISTURBED.name) for name in methods
        ),
        arms=tuple(arm for name in methods for arm in arms if arm.variant == name),
        demonstrations=(UNDISTURBED,),
        ablation_seeds=(),
        progress_every=10,
        progress_episodes=10,
        progress_steps=3000,
    )


PRESETS: dict[str, Callable[[Sequence[str] | None], StudyConfig]] = {
    "quick": quick,
    "standard": standard,
    "paper": paper,
}


def preset(name: str, *, methods: Sequence[str] | None = None) -> StudyConfig:
    """A study by the name of its preset.

    Args:
        name: "quick", "standard" or "paper".
        methods: What is compared; what the preset has if None.

    Raises:
        UnknownNameError: If there is no such preset or method.
    """
    if name not in PRESETS:
        raise UnknownNameError("study preset", name, PRESETS)
    for method in methods or ():
        if method not in METHODS:
            raise UnknownNameError("method", method, METHODS)
    return PRESETS[name](methods)
