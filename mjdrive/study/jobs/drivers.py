"""Who drives in a study, wherever he is sent: a trained run with its way to act, or a reference."""

import dataclasses
import functools
import json
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from mjdrive import config, versions
from mjdrive.config import PidConfig, Reference, SimulationConfig
from mjdrive.datatypes import Episode
from mjdrive.episodes import driving, store
from mjdrive.errors import RunError
from mjdrive.learning.pilot import Pilot
from mjdrive.simulation.simulation import Simulation
from mjdrive.study.jobs.checkpoints import digest
from mjdrive.town.rightmost import rightmost
from models import checkpoint, serialization
from models.config import LearnerConfig, Precision
from models.errors import ModelsError
from models.interfaces import Learner

_LUGGAGE = (checkpoint.CONFIG, checkpoint.MODEL)
"""Files of a run that its agent needs in order to act."""


@dataclass(frozen=True, slots=True)
class Who:
    """Somebody who drives; an agent that is pickled takes its weights along, so other machines need not see its run.

    Attributes:
        name: Of its files: arm and training seed, or the reference.
        digest: SHA-256 of the weights, hexadecimal; empty for a reference.
        run: Folder of the trained run; None for a reference.
        settings: How it acts; None for a reference.
        precision: Number format to score candidates in where the settings of an agent leave it open; grids are float32.
        reference: Which reference it is; None for an agent.
        walk: Which random turns the expert takes from the same starts [-].
        luggage: What an agent needs of its run where it was sent to, by name of the file; None where the run is.
    """

    name: str
    digest: str = ""
    run: Path | None = None
    settings: LearnerConfig | None = None
    precision: Precision = "float32"
    reference: Reference | None = None
    walk: int = 0
    luggage: Mapping[str, bytes] | None = field(default=None, compare=False, repr=False)

    def __reduce__(self) -> tuple[object, ...]:
        """Pack what is needed elsewhere, not before somebody is sent there: studies have hundreds of checkpoints.

        Raises:
            RunError: If the run has other weights than when it was planned.
        """
        values = {it.name: getattr(self, it.name) for it in dataclasses.fields(self)}
        return functools.partial(Who, **values | {"luggage": _luggage(self)}), ()


def agent(name: str, run: Path, settings: LearnerConfig, precision: Precision) -> Who:
    """An agent in a way to act.

    Args:
        name: Of its files.
        run: Folder of the trained run.
        settings: How it acts.
        precision: Number format to score candidates in where its settings leave it open; grids are float32.
    """
    return Who(name, digest(run), run, settings, precision)


def load_learner(who: Who) -> Learner:
    """Load the network of an agent, with the settings that it acts with.

    Raises:
        RunError: If the folder is no run, a file of it is damaged, or it has other weights than when it was planned.
    """
    assert who.settings is not None, "the study says how an agent acts"
    with _run_of(who) as run:
        try:
            learner = checkpoint.load(run)
        except ModelsError as error:
            raise RunError(str(error).replace(str(run), str(who.run))) from error
        if digest(run) != who.digest:
            raise _changed(who)
    # The number format of training stays that which it settled on.
    learner.config = dataclasses.replace(who.settings, optimiser=learner.config.optimiser)
    sampler = learner.config.sampler
    # Else each machine would settle on its own; a grid is scored in float32 on every CPU.
    if sampler.precision == "auto" and sampler.kind != "grid":
        sampler = dataclasses.replace(sampler, precision=who.precision)
        learner.config = dataclasses.replace(learner.config, sampler=sampler)
    return learner


@functools.lru_cache(maxsize=1)
def load_pilot(who: Who) -> Pilot:
    """Load an agent; the last one is kept, as many drives follow each other.

    It acts on the CPU everywhere, so that drives do not depend on who has a GPU.
    """
    return Pilot(load_learner(who), name=who.name, device="cpu")


def drive(
    who: Who, simulation: Simulation, *, num_steps: int, seed: int, on_step: Callable[[int], None]
) -> Episode:
    """Let somebody drive freely, from a random place that only seed and steps decide.

    Args:
        who: Who drives.
        simulation: World to drive in; it is reset.
        num_steps: Control steps [-].
        seed: Same seed, same drive.
        on_step: Told the number of control steps done.

    Raises:
        RunError: If the run of an agent cannot be loaded.
    """
    town = simulation.town
    if who.reference is None:
        pilot = load_pilot(who)
        metadata = _metadata(who, simulation, serialization.to_json(pilot.config), num_steps)
        return driving.drive(
            simulation, pilot, num_steps=num_steps, seed=seed, on_step=on_step, metadata=metadata
        )
    goes_right = who.reference == "right-walker"
    return driving.drive_expert(
        simulation,
        num_steps=num_steps,
        seed=seed,
        on_step=on_step,
        choose=functools.partial(rightmost, town) if goes_right else None,
        walk=who.walk,
        metadata=_metadata(who, simulation, config.to_json(PidConfig()), num_steps),
    )


def _luggage(who: Who) -> Mapping[str, bytes] | None:
    if who.run is None or who.luggage is not None:
        return who.luggage
    try:
        luggage = {name: (who.run / name).read_bytes() for name in _LUGGAGE}
    except FileNotFoundError as error:
        raise _changed(who) from error
    if store.digest(luggage[checkpoint.MODEL]) != who.digest:
        raise _changed(who)
    return luggage


@contextmanager
def _run_of(who: Who) -> Iterator[Path]:
    """The run of an agent, or a folder with what it took along of it."""
    assert who.run is not None, "a reference has no network"
    if who.luggage is None:
        yield who.run
        return
    with tempfile.TemporaryDirectory() as place:
        for name, content in who.luggage.items():
            Path(place, name).write_bytes(content)
        yield Path(place)


def _changed(who: Who) -> RunError:
    return RunError(
        f"The run '{who.run}' has changed since the study began. Run the same command again."
    )


def _metadata(who: Who, simulation: Simulation, settings: str, num_steps: int) -> dict[str, str]:
    """Versions, digests and settings that decide a drive."""
    decided = {
        "num_steps": num_steps,
        "simulation": json.loads(config.to_json(SimulationConfig())),
        "policy": json.loads(settings),
        "driver": who.name,
    }
    return {
        "town_digest": simulation.town.digest,
        "car": simulation.car_model.name,
        "car_digest": simulation.car_model.digest,
        "policy_digest": who.digest,
        "settings": json.dumps(decided, sort_keys=True),
        **versions.to_metadata(versions.versions()),
    }
