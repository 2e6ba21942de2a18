"""A run folder: weights and training state as safetensors, everything else as JSON, written whole or not at all.

config.json            settings of the learner
state.json             method, seed, epochs done, versions
model.safetensors      weights to act with, and what the learner was prepared with
training.safetensors   weights, moments and running means as they were when training stopped
metrics.jsonl          one line an epoch
"""

import hashlib
import importlib.metadata
import json
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import safetensors
import safetensors.torch
import torch
from torch import Tensor

from models.config import LearnerConfig
from models.errors import CheckpointError, SettingError
from models.half_precision import widened
from models.interfaces import Learner
from models.learners import build_learner
from models.serialization import from_json, to_json

CONFIG, STATE, MODEL = "config.json", "state.json", "model.safetensors"
TRAINING, METRICS = "training.safetensors", "metrics.jsonl"
DIGEST = ", sha256 "
"""What stands between epochs and digest in a safetensors file."""


@dataclass(frozen=True, slots=True)
class RunState:
    """How far a run is.

    Attributes:
        method: How the learner learns.
        seed: Seed of weights, order and negatives.
        epoch: Complete epochs.
        epochs: Epochs of the whole run.
        torch_version: Version of torch that trained.
    """

    method: str
    seed: int
    epoch: int
    epochs: int
    torch_version: str = importlib.metadata.version("torch")


def write_atomically(path: Path, content: bytes) -> None:
    """Write a file so that an interruption leaves the old one or the new one, never a part.

    Args:
        path: File to write; its folder must exist.
        content: All bytes of it.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        with temporary.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def write_tensors(path: Path, tensors: Mapping[str, Tensor], *, epoch: int) -> None:
    """Write tensors, with their digest and the number of complete epochs, as one safetensors file."""
    rows = {name: tensor.detach().cpu().contiguous() for name, tensor in tensors.items()}
    # One entry, as safetensors writes several in an order that changes from time to time.
    metadata = {"epoch": f"{epoch}{DIGEST}{digest(rows)}"}
    write_atomically(path, safetensors.torch.save(rows, metadata=metadata))


def digest(tensors: Mapping[str, Tensor]) -> str:
    """SHA-256 of names, types, shapes and bytes of tensors, hexadecimal, whatever their order."""
    hashed = hashlib.sha256()
    for name, tensor in sorted(tensors.items()):
        hashed.update(f"{name} {tensor.dtype} {tuple(tensor.shape)}\n".encode())
        hashed.update(tensor.cpu().contiguous().reshape(-1).view(torch.uint8).numpy().data)
    return hashed.hexdigest()


def read_tensors(path: Path, *, device: torch.device) -> tuple[dict[str, Tensor], int]:
    """Read what `write_tensors` wrote.

    Returns:
        The tensors by name, and the number of complete epochs.

    Raises:
        CheckpointError: If the file is missing, truncated or changed.
    """
    if not path.is_file():
        raise CheckpointError(_missing(path))
    try:
        with safetensors.safe_open(path, framework="pt", device=str(device)) as file:
            tensors = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118
            epoch, _, written = (file.metadata() or {})["epoch"].partition(DIGEST)
            result = tensors, int(epoch)
    except (safetensors.SafetensorError, OSError, KeyError, ValueError) as error:
        raise CheckpointError(
            f"Cannot read '{path}': {error}. Expected the safetensors file of a training run; train again."
        ) from error
    if written and written != digest(tensors):  # older files have none
        raise CheckpointError(
            f"'{path}' is damaged: its tensors are not those whose digest it holds. Copy it again, or train again."
        )
    return result


def save(folder: Path, learner: Learner, state: RunState) -> None:
    """Write settings, weights to act with and progress of a run.

    Args:
        folder: Run folder; made if missing.
        learner: What to save.
        state: How far the run is.
    """
    folder.mkdir(parents=True, exist_ok=True)
    write_atomically(folder / CONFIG, to_json(learner.config).encode())
    write_tensors(folder / MODEL, learner.state_dict(), epoch=state.epoch)
    write_atomically(folder / STATE, (json.dumps(asdict(state), indent=2) + "\n").encode())


def load(folder: Path, *, device: torch.device | str = "cpu") -> Learner:
    """Read a trained learner.

    Args:
        folder: Run folder.
        device: Where to put the weights.

    Returns:
        The learner, ready to act.

    Raises:
        CheckpointError: If the folder is no run, a file of it is missing, truncated or of another network, or a weight
            is no finite number.
    """
    learner = build_learner(load_config(folder), seed=0)
    tensors, _ = read_tensors(folder / MODEL, device=torch.device("cpu"))
    tensors = widened(tensors)  # shipped weights may be float16
    try:
        learner.load_state_dict(tensors)
    except RuntimeError as error:
        raise CheckpointError(
            f"'{folder / MODEL}' does not fit the network of '{folder / CONFIG}': {error}"
        ) from error
    broken = [name for name, tensor in tensors.items() if not tensor.isfinite().all()]
    if broken:
        raise CheckpointError(
            f"'{folder / MODEL}' holds weights that are not finite ({', '.join(broken[:3])}); expected numbers. Train "
            f"again with a lower optimiser.learning_rate."
        )
    return learner.to(device).eval()


def load_config(folder: Path) -> LearnerConfig:
    """Read the settings of a run.

    Raises:
        CheckpointError: If the file is missing or its settings are not those of a learner.
    """
    try:
        return from_json(_read_text(folder / CONFIG))
    except SettingError as error:
        raise CheckpointError(f"'{folder / CONFIG}': {error}") from error


def load_state(folder: Path) -> RunState:
    """Read how far a run is.

    Raises:
        CheckpointError: If the file is missing or not what `save` wrote.
    """
    try:
        values: dict[str, Any] = json.loads(_read_text(folder / STATE))
        return RunState(**values)
    except (json.JSONDecodeError, TypeError) as error:
        raise CheckpointError(
            f"Cannot read '{folder / STATE}': {error}. Expected the state of a training run."
        ) from error


def _read_text(path: Path) -> str:
    if not path.is_file():
        raise CheckpointError(_missing(path))
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise CheckpointError(
            f"Cannot read '{path}': {error}. Expected text; train again."
        ) from error


def _missing(path: Path) -> str:
    if not path.parent.is_dir():
        return f"There is no run folder '{path.parent}'. Train first, or give the folder of a run."
    names = sorted(entry.name for entry in path.parent.iterdir())
    found = ", ".join([*names[:5], "..."] if len(names) > 5 else names) or "nothing"
    return f"'{path.parent}' is no complete training run: expected {path.name}, found {found}."
