"""What several processes make sure of before they train one network together."""

import dataclasses
from collections.abc import Mapping
from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor, distributed

from models import checkpoint
from models.config import LearnerConfig
from models.distributed import Team, told_of_losses
from models.errors import HardwareError, TrainingError


def require_shares(team: Team, batch_size: int) -> None:
    """Refuse minibatches with fewer pairs than processes.

    Args:
        team: The processes.
        batch_size: Pairs that they share at each step [-].

    Raises:
        TrainingError: If some process would never get a pair.
    """
    if batch_size < team.size:
        raise TrainingError(
            f"{team.size} processes share minibatches of {batch_size} pairs; expected at least one pair for each. Start "
            f"fewer processes, or raise optimiser.batch_size."
        )


def facts(
    config: LearnerConfig,
    *,
    seed: int,
    actions: Float[Tensor, "D 2"],
    states: Float[Tensor, "D 3"],
    num_epochs_done: int,
) -> dict[str, str]:
    """What has to be the same in all processes, by its name.

    Args:
        config: Settled settings.
        seed: Of the run.
        actions: Every expert action [-].
        states: Every speed [m/s], previous acceleration and previous steering [-].
        num_epochs_done: Complete epochs [-].
    """
    return {
        **_leaves(dataclasses.asdict(config)),
        "seed": str(seed),
        "number of pairs": str(len(actions)),
        "digest of the actions": checkpoint.digest({"actions": actions})[:12],
        "digest of the states": checkpoint.digest({"states": states})[:12],
        "complete epochs": str(num_epochs_done),
        "version of torch": torch.__version__,
    }


def require_same(team: Team, facts: Mapping[str, str]) -> None:
    """Refuse to train when the processes of a team are about to train different things.

    Args:
        team: The processes, inside `distributed.joined`.
        facts: What has to be the same everywhere, by its name.

    Raises:
        HardwareError: If it is not, in all processes alike; or if one of them is lost.
    """
    if team.size == 1:
        return
    found: list[dict[str, str]] = [{} for _ in range(team.size)]
    with told_of_losses(team):
        distributed.all_gather_object(found, dict(facts))
    first, *others = found
    for rank, other in enumerate(others, start=1):
        differing = {
            name: (first[name], other[name]) for name in first if first[name] != other[name]
        }
        if differing:
            listed = "; ".join(f"{name}: {one}, {two}" for name, (one, two) in differing.items())
            raise HardwareError(
                f"Processes 0 and {rank} would not train the same ({listed}). Give all of them the same options, data "
                f"and versions; --set optimiser.precision=float32 suits every machine."
            )


def _leaves(settings: Mapping[str, Any], prefix: str = "") -> dict[str, str]:
    """Every setting by its dotted name."""
    leaves: dict[str, str] = {}
    for name, value in settings.items():
        if isinstance(value, dict):
            leaves |= _leaves(value, f"{prefix}{name}.")
        else:
            leaves[prefix + name] = str(value)
    return leaves
