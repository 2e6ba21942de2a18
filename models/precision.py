"""The number format that a run trains in: settled once, recorded, and kept when it goes on."""

import dataclasses
from pathlib import Path

import torch

from models import checkpoint, hardware
from models.config import LearnerConfig
from models.energy_scoring import resolved


def settle(
    config: LearnerConfig, *, device: torch.device | str, run: Path | None = None
) -> LearnerConfig:
    """Replace the precision "auto" by what it means here.

    Args:
        config: Settings to train with.
        device: Where.
        run: Folder of the run that goes on, whose number format is kept; None where a new one begins.

    Returns:
        The settings with the precision "float32" or "bfloat16".

    Raises:
        CheckpointError: If the folder of the run has no settings.
    """
    if config.optimiser.precision != "auto":
        return config
    if run is None:
        precision = resolved("auto", device)
    else:
        precision = checkpoint.load_config(run).optimiser.precision
    return dataclasses.replace(
        config, optimiser=dataclasses.replace(config.optimiser, precision=precision)
    )


def in_words(config: LearnerConfig, *, device: torch.device, resumes: bool = False) -> str:
    """Say where and in which number format a run trains, and what is slow about it.

    Args:
        config: Settled settings.
        device: Where.
        resumes: Whether a run goes on, whose number format stays; then no other is recommended.

    Returns:
        One line.
    """
    precision = config.optimiser.precision
    text = f"Training on {device} in {precision}"
    is_fast = hardware.bfloat16_is_fast(device)
    if resumes:
        slow = precision == "bfloat16" and not is_fast
        return f"{text}, as this run began{'; that is slow here' if slow else ''}."
    if precision == "bfloat16" and not is_fast:
        return f"{text}, which is slow here; --set optimiser.precision=float32 is quicker."
    if precision == "float32" and is_fast:
        return f"{text}; --set optimiser.precision=bfloat16 is quicker here."
    return f"{text}."
