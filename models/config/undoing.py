"""Refuses to take out at inference what training did not put in, or took out itself."""

from models.config.implicit import DensityConfig, NegativesConfig
from models.config.samplers import Undo
from models.errors import SettingError

ENERGIES = ("ibc", "da-ibc", "ibc-langevin")
"""Methods that remember the demonstrations, without which nothing can be undone."""


def require_undoable(
    undo: Undo, *, method: str, negatives: NegativesConfig, density: DensityConfig
) -> None:
    """Refuse a setting `sampler.undo` that corrects for nothing, twice, or for what has no density.

    Args:
        undo: What acting is to take out again.
        method: How the learner learns.
        negatives: What the energy is trained against.
        density: What 1 / KDE weighs.

    Raises:
        SettingError: If the settings do not go together.
    """
    if undo != "none" and method not in ENERGIES:
        raise SettingError(
            f"sampler.undo is '{undo}', but {method} does not remember the demonstrations to undo it by; expected one of "
            f"{', '.join(ENERGIES)}. Set sampler.undo=none."
        )
    if undo in {"negatives", "both"}:
        _require_known_density(undo, method, negatives)
    if undo in {"density", "both"} and density.weighting == "none":
        other = "negatives" if undo == "both" else "none"
        raise SettingError(
            f"sampler.undo is '{undo}', but density.weighting is 'none': no weights tilted what was learnt. Set "
            f"sampler.undo={other}."
        )


def _require_known_density(undo: Undo, method: str, negatives: NegativesConfig) -> None:
    given, other = f"sampler.undo is '{undo}'", "density" if undo == "both" else "none"
    if method == "ibc":
        raise SettingError(
            f"{given}, but the negatives of ibc are uniform and tilt nothing. Set sampler.undo={other}."
        )
    if method != "da-ibc":
        raise SettingError(
            f"{given}, but {method} has no negatives whose density is known; expected da-ibc. Set sampler.undo={other}."
        )
    if negatives.correction != "none":
        raise SettingError(
            f"{given}, but negatives.correction is '{negatives.correction}', so training has corrected for them "
            f"already. Set sampler.undo={other}, or train with negatives.correction=none."
        )
    if negatives.clip or negatives.sigma == 0:
        raise SettingError(
            f"{given}, but clipped negatives pile up on the edges and those without noise on points, where they have no "
            f"density. Train with negatives.clip=false and a positive negatives.sigma, or set sampler.undo={other}."
        )
