"""Data set -> trained run folder."""

import dataclasses
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np

from mjdrive.config import read_json, write_json
from mjdrive.episodes import dataset
from mjdrive.errors import RunError
from mjdrive.learning import runs
from mjdrive.learning.batches import EpisodeDemonstrations, Views, demonstrations_of
from mjdrive.learning.perturbation import perturb
from mjdrive.town import library
from mjdrive.vehicle.cars import DEFAULT
from mjdrive.versions import versions
from models import agreement, distributed, precision
from models.config import LearnerConfig
from models.distributed import ALONE, Team
from models.errors import ModelsError
from models.hardware import choose_device
from models.learners import build_learner
from models.progress import EpochReport, StepReport
from models.training import fit

_PERTURBATION_STREAM = 1
"""Sets chance of poses apart from all other of a run."""


@dataclasses.dataclass(frozen=True, slots=True)
class Source:
    """What a run was trained on.

    Attributes:
        town: Town of the demonstrations.
        manifest_sha256: Digest of the manifest of the data set, hexadecimal.
        num_demonstrations: Pairs of observation and action [-].
        versions: Versions of the software that trained.
        cars: Name of each car that drove in them, by its digest; runs from before one could choose know the default
            car alone, by no digest.
    """

    town: str
    manifest_sha256: str
    num_demonstrations: int
    versions: dict[str, str]
    cars: dict[str, str] = dataclasses.field(default_factory=lambda: {"": DEFAULT})

    def require_same(self, earlier: "Source", run: Path) -> None:
        """Refuse to go on with a run that was begun on other data.

        Args:
            earlier: What the run was trained on so far.
            run: Its folder, for the message.

        Raises:
            RunError: If town or data set differ.
        """
        if (self.town, self.manifest_sha256) != (earlier.town, earlier.manifest_sha256):
            raise RunError(
                f"'{run}' was begun on another data set of {earlier.town} ({earlier.num_demonstrations} pairs; here "
                f"are {self.num_demonstrations}). Resume with --data as before, or start again with --overwrite."
            )


def find_team() -> Team:
    """The processes that torchrun started to train together; this one alone if it started none.

    Raises:
        RunError: If the environment is half of torchrun's.
    """
    try:
        return distributed.team_of(os.environ)
    except ModelsError as error:
        raise RunError(str(error)) from error


def train(
    config: LearnerConfig,
    *,
    data: Path,
    run: Path,
    seed: int,
    resume: bool = False,
    overwrite: bool = False,
    device: str = "auto",
    views: Views = "auto",
    team: Team = ALONE,
    on_note: Callable[[str], None] | None = None,
    on_frame: Callable[[int, int], None] | None = None,
    on_step: Callable[[StepReport], None] | None = None,
    on_epoch: Callable[[EpochReport], None] | None = None,
) -> list[EpochReport]:
    """Train a policy on the demonstrations of a folder.

    Args:
        config: Method and settings.
        data: Folder that `mjdrive collect` made.
        run: Folder to write checkpoint, metrics and settings to.
        seed: Decides first weights, order of the data and negatives.
        resume: Whether to go on from the last complete epoch in `run`.
        overwrite: Whether a run that is in `run` is replaced, once the new one is ready for its first step.
        device: Where to train: "auto" for a GPU where there is one, or "cpu", "cuda", "cuda:1".
        views: Where the views are meanwhile: in memory, drawn when they are needed, or whichever suits their number.
        team: The processes that train together, from `find_team()`; the first one writes.
        on_note: Told in a line where and in which number format training goes on.
        on_frame: Told how many of how many views are drawn, where all are at the start.
        on_step: Told about each step.
        on_epoch: Told about each epoch once its checkpoint is complete.

    Returns:
        One report an epoch.

    Raises:
        DataError: If the data folder is missing, unfinished or damaged.
        RunError: If the run folder is in use, there is nothing to resume, the device is not there, or the processes
            do not find each other or train different things.
    """
    if resume:
        runs.require_begun(run)
    elif not overwrite and team.leads:
        runs.require_free(run)
    try:
        place = team.device(choose_device(device))
        config = precision.settle(config, device=place, run=run if resume else None)
        if on_note is not None:
            on_note(precision.in_words(config, device=place, resumes=resume))
        agreement.require_shares(team, config.optimiser.batch_size)
        with distributed.joined(team, place):
            demonstrations, source = _read(data, views, config, seed, on_frame)
            if resume:
                source.require_same(read_json(Source, run / runs.SOURCE), run)
            return fit(
                build_learner(config, seed=seed),
                demonstrations.to(place),
                config,
                folder=run,
                seed=seed,
                resume=resume,
                on_ready=(lambda: _begin(run, source, replaces=overwrite)) if team.leads else None,
                on_epoch=on_epoch,
                on_step=on_step,
                device=place,
                team=team,
            )
    except ModelsError as error:
        raise RunError(str(error)) from error


def _begin(run: Path, source: Source, *, replaces: bool) -> None:
    """Make a run folder ready, and delete the run that is in it if that is to be replaced."""
    if replaces:
        runs.remove(run)
    write_json(source, run / runs.SOURCE)


def _read(
    data: Path,
    views: Views,
    config: LearnerConfig,
    seed: int,
    on_frame: Callable[[int, int], None] | None,
) -> tuple[EpisodeDemonstrations, Source]:
    """Read a data set and make ready what the expert saw, or would have seen from beside."""
    manifest, episodes = dataset.read_dataset(data)
    if config.perturbation.share > 0:
        rng = np.random.default_rng([seed, _PERTURBATION_STREAM])
        episodes = [perturb(episode, config.perturbation, rng) for episode in episodes]
    total = sum(entry.steps for entry in manifest.episodes)
    demonstrations = demonstrations_of(
        episodes,
        library.load(manifest.town),
        views=views,
        on_frame=on_frame and (lambda done: on_frame(done, total)),
    )
    return demonstrations, Source(
        town=manifest.town,
        manifest_sha256=dataset.digest(data),
        num_demonstrations=len(demonstrations),
        versions=versions(),
        cars={driven.car_digest: driven.car for driven in manifest.collections},
    )
