"""Runs of a study: whether they are the planned ones, and the checkpoints that they keep of epochs before the last."""

import dataclasses
import json
import shutil
from pathlib import Path
from typing import Any

from mjdrive.config import read_json
from mjdrive.episodes import store
from mjdrive.errors import RunError
from mjdrive.learning import runs
from mjdrive.learning.settings import ACTING
from mjdrive.learning.training import Source
from mjdrive.study.settings.agents import Agent
from models import checkpoint, serialization
from models.config import LearnerConfig, settings_of
from models.errors import ModelsError
from models.run_folder import read_history

EPOCHS = "epochs"
"""Folder in a run folder that holds checkpoints of epochs before the last."""

_KEPT = (runs.SOURCE, checkpoint.CONFIG, checkpoint.MODEL, checkpoint.STATE)
"""What a checkpoint that only drives consists of."""


def keep_epoch(run: Path, *, every: int) -> None:
    """Keep a copy of the last complete epoch of a run if it is due and not kept yet.

    Args:
        run: Run folder with at least one complete epoch.
        every: Epochs between two copies; the last epoch of a run needs none; 0 keeps nothing [-].
    """
    state = checkpoint.load_state(run)
    place = run / EPOCHS / f"{state.epoch:04d}"
    if every == 0 or state.epoch % every or state.epoch == state.epochs or place.is_dir():
        return
    unfinished = place.with_name(f".{place.name}")
    shutil.rmtree(unfinished, ignore_errors=True)
    unfinished.mkdir(parents=True)
    for name in _KEPT:
        shutil.copyfile(run / name, unfinished / name)
    unfinished.rename(place)


def kept_epochs(run: Path) -> dict[int, Path]:
    """Checkpoints of a complete run by epoch, the last one included."""
    kept = {int(path.name): path for path in sorted((run / EPOCHS).glob("[0-9]*"))}
    return kept | {checkpoint.load_state(run).epoch: run}


def losses(run: Path) -> dict[int, float]:
    """Mean training loss of each complete epoch of a run [nats]."""
    history = read_history(run / checkpoint.METRICS, checkpoint.load_state(run).epoch)
    return {report.epoch: report.loss for report in history}


def is_complete(run: Path) -> bool:
    """Whether a run is there and has all of its epochs."""
    if not runs.is_run(run):
        return False
    state = checkpoint.load_state(run)
    return state.epoch >= state.epochs


def digest(run: Path) -> str:
    """SHA-256 of the weights that a run acts with, hexadecimal."""
    return store.digest((run / checkpoint.MODEL).read_bytes())


def find_run(agent: Agent, trained: Path) -> Path | None:
    """Find the complete run of an agent in a folder of trained runs; None if there is none.

    Args:
        agent: Whose run.
        trained: Folder with run folders, called after the variant, or after variant and seed as `bc-beta-0`.
    """
    for name in (agent.name, agent.variant.name):
        run = trained / name
        if is_complete(run) and checkpoint.load_state(run).seed == agent.seed:
            return run
    return None


def require_planned(run: Path, agent: Agent, config: LearnerConfig) -> None:
    """Refuse a run that has not learnt what the study says; how it acts is for the study's arms to say, whatever it has.

    Args:
        run: Run folder.
        agent: Whose it is.
        config: Settings that the study has for it.

    Raises:
        RunError: If it was trained with other settings or another seed.
    """
    try:
        found, state = checkpoint.load_config(run), checkpoint.load_state(run)
    except ModelsError as error:
        raise RunError(str(error)) from error
    differing = _differing(_settled_as(config, found), found)
    if state.seed != agent.seed:
        differing.append(f"seed {state.seed} (here {agent.seed})")
    if differing:
        raise RunError(
            f"The run '{run}' was trained with other settings than the study has for {agent.name}: "
            f"{', '.join(differing)}. Change those of the study with --set, or leave the run out and let it be trained."
        )


def require_trained_on(run: Path, agent: Agent, *, manifest_sha256: str) -> None:
    """Refuse a run that has learnt from something else than the study says.

    Args:
        run: Run folder.
        agent: Whose it is.
        manifest_sha256: Digest of the data set that the study has for it, hexadecimal.

    Raises:
        RunError: If it was trained on other data.
    """
    if read_json(Source, run / runs.SOURCE).manifest_sha256 != manifest_sha256:
        raise RunError(
            f"The run '{run}' was trained on another data set than the study has for {agent.name}. Give its data set "
            f"with --data, or leave the run out and let it be trained."
        )


def _settled_as(config: LearnerConfig, found: LearnerConfig) -> LearnerConfig:
    """Settings with the number format that a run settled on, where they leave that open."""
    if config.optimiser.precision != "auto":
        return config
    optimiser = dataclasses.replace(config.optimiser, precision=found.optimiser.precision)
    return dataclasses.replace(config, optimiser=optimiser)


def _differing(wanted: LearnerConfig, found: LearnerConfig) -> list[str]:
    """Settings that differ and have an effect on what is learnt, with both values."""
    here, there = effective_settings(wanted), effective_settings(found)
    return [
        f"{name} {there.get(name)} (here {here.get(name)})"
        for name in sorted({*here, *there})
        if here.get(name) != there.get(name) and not name.startswith(ACTING)
    ]


def effective_settings(config: LearnerConfig) -> dict[str, Any]:
    """The settings of a learner that have an effect on it, as JSON values by their dotted names."""
    matters = settings_of(config.method)
    values = _flat(json.loads(serialization.to_json(config)))
    return {name: value for name, value in values.items() if name.startswith(matters)}


def _flat(values: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, dict):
            flat |= _flat(value, f"{prefix}{name}.")
        else:
            flat[f"{prefix}{name}"] = value
    return flat
