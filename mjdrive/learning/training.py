"""Data set -> trained run folder."""

import dataclasses
from collections.abc import Callable
from pathlib import Path

import torch

from mjdrive import config as settings
from mjdrive.episodes import dataset, provenance, store
from mjdrive.errors import RunError
from mjdrive.files import write_atomically
from mjdrive.learning.batches import PackedDemonstrations
from mjdrive.town import library
from models.config import LearnerConfig
from models.errors import ModelsError
from models.learners import build_learner
from models.progress import EpochReport, StepReport
from models.training import fit

SOURCE = "source.json"


@dataclasses.dataclass(frozen=True, slots=True)
class Source:
    """What a run was trained on.

    Attributes:
        town: Town of the demonstrations.
        manifest_sha256: Digest of the manifest of the data set, hexadecimal.
        num_demonstrations: Pairs of observation and action [-].
        versions: Versions of the software that trained.
    """

    town: str
    manifest_sha256: str
    num_demonstrations: int
    versions: dict[str, str]


def train(
    config: LearnerConfig,
    *,
    data: Path,
    run: Path,
    seed: int,
    resume: bool = False,
    device: str = "cpu",
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
        device: Where to train, as torch names it.
        on_frame: Told how many of how many views are drawn.
        on_step: Told about each step.
        on_epoch: Told about each epoch once its checkpoint is complete.

    Returns:
        One report an epoch.

    Raises:
        DataError: If the data folder is missing, unfinished or damaged.
        RunError: If the run folder is in use, or there is nothing to resume.
    """
    manifest, episodes = dataset.read_dataset(data)
    total = sum(entry.steps for entry in manifest.episodes)
    demonstrations = PackedDemonstrations(
        episodes,
        library.load(manifest.town),
        on_frame=on_frame and (lambda done: on_frame(done, total)),
    ).to(torch.device(device))
    source = Source(
        town=manifest.town,
        manifest_sha256=store.digest((data / dataset.MANIFEST).read_bytes()),
        num_demonstrations=len(demonstrations),
        versions=provenance.versions(),
    )
    try:
        reports = fit(
            build_learner(config, seed=seed),
            demonstrations,
            config,
            folder=run,
            seed=seed,
            resume=resume,
            on_epoch=on_epoch,
            on_step=on_step,
            device=device,
        )
    except ModelsError as error:
        raise RunError(str(error)) from error
    write_atomically(run / SOURCE, settings.to_json(source).encode())
    return reports
