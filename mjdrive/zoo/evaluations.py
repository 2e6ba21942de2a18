"""Folders of drives -> what a model card says of how a policy drives."""

import json
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from mjdrive import config
from mjdrive.errors import DataError
from mjdrive.evaluation import report
from mjdrive.evaluation.drives import DESCRIPTION
from mjdrive.evaluation.metrics import DriveSummary
from mjdrive.evaluation.spread import summarise_drives
from mjdrive.town import library
from mjdrive.vehicle import cars
from mjdrive.zoo.cards import Evaluation
from mjdrive.zoo.entries import PREFIX
from models import serialization
from models.config import LearnerConfig


def read_evaluation(
    folder: Path, *, name: str, acting: LearnerConfig, digests: Collection[str]
) -> Evaluation:
    """Read the drives of a policy.

    Args:
        folder: What `mjdrive drive --episodes N` or `scripts/compare_policies.py` left, one folder a drive.
        name: Of the entry that will be driven again.
        acting: Settings that the entry acts with.
        digests: Of its weights, as they are shipped and as training left them, hexadecimal.

    Raises:
        DataError: If there are no drives, or another policy or other settings made them.
    """
    description = _description(folder)
    _require_driven_by(description, folder, acting, digests)
    drives = [
        config.read_json(DriveSummary, path) for path in sorted(folder.glob(f"*/{report.SUMMARY}"))
    ]
    if not drives:
        raise DataError(
            f"'{folder}' holds no drive. Expected drives to evaluate {name} by; make them first."
        )
    summary = summarise_drives(drives, library.load(description["town"]))
    return Evaluation(
        command=_command(description, name=name, num_drives=len(drives), steps=drives[0].steps),
        weights_sha256=description["policy_digest"],
        steps=drives[0].steps,
        summary=summary,
    )


def _description(folder: Path) -> dict[str, str]:
    """What the drives of a folder have in common."""
    try:
        values: dict[str, str] = json.loads((folder / DESCRIPTION).read_text())
        settings: dict[str, Any] = json.loads(values["settings"])
        known = {name: values[name] for name in ("town", "car", "policy_digest")}
        seed = {"seed": values["seed"]} if "seed" in values else {}
        return {**known, **seed, "acting": json.dumps(settings["policy"])}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise DataError(
            f"Cannot read '{folder / DESCRIPTION}': {error}. Expected the folder that `mjdrive drive --episodes N` or "
            f"scripts/compare_policies.py left."
        ) from error


def _require_driven_by(
    description: Mapping[str, str], folder: Path, acting: LearnerConfig, digests: Collection[str]
) -> None:
    """Refuse drives of other weights, or with another way to act."""
    drove = description["policy_digest"]
    if drove not in digests:
        shown = " or ".join(digest[:12] for digest in digests)
        raise DataError(
            f"The drives in '{folder}' were made by the weights {drove[:12] or 'of an expert'}; expected {shown}. "
            f"Let the same policy drive."
        )
    wanted, found = (
        json.loads(text) for text in (serialization.to_json(acting), description["acting"])
    )
    for settings in (wanted, found):
        settings["sampler"].pop("precision")  # it settles on the machine that drives
    if wanted != found:
        raise DataError(
            f"The drives in '{folder}' were made with other settings than those that the policy is shipped with. Drive "
            f"without --preset, or ship it with --set as it drove."
        )


def _command(description: Mapping[str, str], *, name: str, num_drives: int, steps: int) -> str:
    """The command that makes the drives again with what is shipped."""
    town = description["town"]
    if "seed" not in description:
        return (
            f"python scripts/compare_policies.py {PREFIX}{name} --town {town} --steps {steps} "
            f"--seeds {num_drives}"
        )
    car = description["car"]
    return (
        f"mjdrive drive --policy {PREFIX}{name} --town {town} --steps {steps} --episodes {num_drives} "
        f"--seed {description['seed']}{'' if car == cars.DEFAULT else f' --car {car}'}"
    )
