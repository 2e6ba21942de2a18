"""The reference drive of a shipped policy: made once, and made again to see that it still drives so.

What can be promised? Weights, towns and random numbers are the same bits everywhere. Sums of float32 are not: libraries
add in another order on another processor, so energies differ in the seventh digit, and with them, a little later, the
path. So the actions are promised bit for bit where the versions are the same and the machine rounds alike, and the path
to within `TOLERANCE` elsewhere. A policy that draws from a grid does the very same there, too, unless a draw falls
between two points by less than the rounding: DA-IBC did, bit for bit, with AVX512 and with SSE4.1 alone.
"""

import dataclasses
import hashlib
from collections.abc import Callable
from pathlib import Path

import torch

from mjdrive import versions
from mjdrive.episodes.driving import drive
from mjdrive.errors import RunError
from mjdrive.evaluation.metrics import distance_on_lanes
from mjdrive.learning.batches import PackedDemonstrations
from mjdrive.learning.pilot import Pilot
from mjdrive.simulation.simulation import Simulation
from mjdrive.zoo.cards import ReferenceDrive
from models import checkpoint
from models.errors import ModelsError
from models.interfaces import Batch, Learner
from models.samplers.grid import action_grid
from models.threads import one_thread

TOWN = "town02"
STEPS = 100
LEAST_DISTANCE = 30.0
"""A reference drive shorter than this says little [m]."""

MOST_SEEDS = 20
TOLERANCE = 0.5
"""Distance and end of the drive on a machine that rounds otherwise [m]."""

DECISIVE = ("mujoco", "numpy", "opencv", "shapely", "torch")
"""Packages whose version decides the bits of a drive; mjdrive itself has to keep them."""


def make_reference(
    entry: Path, simulation: Simulation, *, on_step: Callable[[int], None] | None = None
) -> ReferenceDrive:
    """Make the reference drive of an entry: the first seed with which it goes somewhere.

    Args:
        entry: Folder with weights and settings.
        simulation: World to drive in; it is reset.
        on_step: Told the number of control steps done.

    Raises:
        RunError: If the policy hardly moves with any seed, or cannot be loaded.
    """
    for seed in range(MOST_SEEDS):
        made = drive_reference(entry, simulation, seed=seed, num_steps=STEPS, on_step=on_step)
        if made.distance_m >= LEAST_DISTANCE:
            return made
    raise RunError(
        f"The policy in '{entry}' goes less than {LEAST_DISTANCE:g} m in {STEPS} steps with each of {MOST_SEEDS} seeds. "
        f"Expected one that drives; look at it with `mjdrive drive --policy RUN --town {simulation.town.name}`."
    )


def drive_reference(
    entry: Path,
    simulation: Simulation,
    *,
    seed: int,
    num_steps: int,
    on_step: Callable[[int], None] | None = None,
) -> ReferenceDrive:
    """Drive as a reference drive is driven.

    Args:
        entry: Folder with weights and settings.
        simulation: World to drive in; it is reset.
        seed: Of the drive.
        num_steps: Control steps [-].
        on_step: Told the number of control steps done.

    Raises:
        RunError: If the policy cannot be loaded.
    """
    learner = _in_float32(entry)
    policy = Pilot(learner, name=entry.name, device="cpu")
    episode = drive(simulation, policy, num_steps=num_steps, seed=seed, on_step=on_step)
    moments = PackedDemonstrations([episode], simulation.town)
    end_x, end_y = episode.vehicle[-1, :2].tolist()
    return ReferenceDrive(
        town=simulation.town.name,
        seed=seed,
        steps=num_steps,
        distance_m=distance_on_lanes(episode),
        end_x=end_x,
        end_y=end_y,
        actions_sha256=hashlib.sha256(episode.actions.tobytes()).hexdigest(),
        rounding=_rounding(learner, moments.batch(torch.tensor([0]))),
        versions={name: versions.all_versions()[name] for name in DECISIVE},
    )


def rounds_alike(one: ReferenceDrive, other: ReferenceDrive) -> bool:
    """Whether two reference drives were made where they have to be the same bit for bit."""
    return (one.rounding, one.versions) == (other.rounding, other.versions)


def _in_float32(entry: Path) -> Learner:
    """Load a policy that scores candidates in float32."""
    try:
        learner = checkpoint.load(entry)
    except ModelsError as error:
        raise RunError(str(error)) from error
    sampler = dataclasses.replace(learner.config.sampler, precision="float32")
    learner.config = dataclasses.replace(learner.config, sampler=sampler)
    return learner


def _rounding(learner: Learner, first: Batch) -> str:
    """What this machine makes of the first moment of a drive."""
    with one_thread():
        told = learner.log_density(first.bev, first.state, action_grid(9)[None])
    digest = hashlib.sha256(told.numpy().tobytes()).hexdigest()
    return f"{torch.backends.cpu.get_cpu_capability()} {digest[:16]}"
