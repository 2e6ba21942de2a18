"""Who drives: the expert, or a trained run, behind one call."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from mjdrive import config, plugins, versions
from mjdrive.cli.solving import late_row, solve_rows
from mjdrive.config import CollectConfig, SimulationConfig
from mjdrive.datatypes import Episode, Observation, Policy, Town
from mjdrive.episodes import driving, plugged, presets, store
from mjdrive.errors import ConfigError
from mjdrive.expert import experts
from mjdrive.expert.solves import SOLVER, SOLVES
from mjdrive.simulation.simulation import Simulation
from mjdrive.tuning.gains import applied
from mjdrive.vehicle.cars import CarModel


@dataclass(frozen=True, slots=True)
class Driver:
    """A policy that is ready to drive.

    Attributes:
        name: How summaries call it.
        digest: SHA-256 of its weights, hexadecimal; empty for an expert.
        settings: Its settings as JSON text.
        pilot: The policy that sees what learned ones may, or None for an expert.
        device: Where a trained policy acts; empty for others.
        expert: Which expert drives and its settings, or None for a trained policy.
        learnt_cars: Name of each car whose demonstrations it learnt from, by its digest; none for the expert.
    """

    name: str
    settings: str
    digest: str = ""
    pilot: Policy[Observation] | None = None
    device: str = ""
    expert: CollectConfig | None = None
    learnt_cars: Mapping[str, str] = field(default_factory=dict)

    def car_note(self, car: CarModel) -> str:
        """Name a car for people, and those that the policy learnt from if there are others."""
        others = {digest: name for digest, name in self.learnt_cars.items() if digest != car.digest}
        if not others or others == {"": car.name}:
            return car.name
        names = sorted(set(self.learnt_cars.values()))
        learnt = "another version of it" if names == [car.name] else " and ".join(names)
        return f"{car.name}; the policy learnt from {learnt}"

    def tuned(self, gains: Path, car: CarModel) -> "Driver":
        """The same expert with settings that `mjdrive tune` found.

        Raises:
            ConfigError: If the driver is no expert, or the file was made for another expert or car.
        """
        if self.expert is None or self.expert.expert not in experts.NAMES:
            raise ConfigError(
                f"--gains {gains} has no effect on {self.name}. Leave it out, or name an expert "
                f"with --policy: {', '.join(experts.NAMES)}."
            )
        return _expert_driver(applied(self.expert, gains, car))

    def solved_by(self, choice: presets.SolverChoice) -> "Driver":
        """The same expert with another solver, or another answer to late plans, if one is named.

        Raises:
            ConfigError: If the driver solves nothing.
        """
        if not choice.options:
            return self
        if self.expert is None:
            raise ConfigError(
                f"{choice.options} has no effect on the trained policy {self.name}, which solves nothing. "
                f"Leave it out, or take --policy mpc."
            )
        return _expert_driver(presets.with_solver(self.expert, choice))

    def solve_notes(self, episode: Episode, late: int) -> dict[str, str]:
        """Sum up the solves of a drive for people; nothing if the driver solves nothing.

        Args:
            episode: The drive.
            late: Plans that came late [-].
        """
        if self.expert is None or SOLVER not in episode.metadata:
            return {}
        solves = json.loads(episode.metadata[SOLVES])
        rows = solve_rows([episode.metadata[SOLVER]], [solves])
        return rows | late_row(late, self.expert.mpc.late_after, self.expert.mpc.late_plan)

    def metadata(self, town: Town, car: CarModel, num_steps: int) -> dict[str, str]:
        """Versions, digests and settings that decide a drive, all but its seed.

        Args:
            town: Where it is driven.
            car: Which car is driven.
            num_steps: Control steps [-].
        """
        settings = {
            "num_steps": num_steps,
            "simulation": json.loads(config.to_json(SimulationConfig())),
            "policy": json.loads(self.settings),
        }
        return {
            "town_digest": town.digest,
            "car": car.name,
            "car_digest": car.digest,
            "policy_cars": json.dumps(dict(self.learnt_cars), sort_keys=True),
            "policy_digest": self.digest,
            **({"policy_device": self.device} if self.device else {}),
            "settings": json.dumps(settings, sort_keys=True),
            **versions.to_metadata(versions.versions()),
        }

    def drive(
        self,
        simulation: Simulation,
        *,
        num_steps: int,
        seed: int,
        on_step: Callable[[int], None],
        on_late_plans: Callable[[int], None] | None = None,
    ) -> Episode:
        """Drive freely, from a random place.

        Args:
            simulation: World to drive in; it is reset.
            num_steps: Control steps [-].
            seed: Same seed, same drive.
            on_step: Told the number of control steps done.
            on_late_plans: Told at the end how many plans of an expert came late on this machine.
        """
        metadata = self.metadata(simulation.town, simulation.car_model, num_steps)
        if self.pilot is None:
            assert self.expert is not None, "a driver is a trained policy or an expert"
            return driving.drive_expert(
                simulation,
                num_steps=num_steps,
                seed=seed,
                config=self.expert,
                on_step=on_step,
                on_late_plans=on_late_plans,
                metadata=metadata,
            )
        return driving.drive(
            simulation,
            self.pilot,
            num_steps=num_steps,
            seed=seed,
            on_step=on_step,
            metadata=metadata,
        )


def find_driver(
    name: str | None,
    runs: Path,
    *,
    preset: str | None = None,
    acting: Sequence[str] = (),
    on_note: Callable[[str], None] = lambda note: None,
) -> Driver:
    """Find out who shall drive.

    Args:
        name: "pid", "mpc", an expert or policy of another package, a run folder, the name of a folder in `runs`, a shipped policy as "zoo:da-ibc", or None for
            the newest run and, where there is none, the shipped policy that drives by default.
        runs: Folder of run folders.
        preset: How a trained policy chooses its actions; as it was trained to if None.
        acting: Changes to how it does, each as "commitment.hold=0".
        on_note: Told in a line who drives if that may surprise.

    Raises:
        ConfigError: If there is no such preset, a change is none of how a policy acts, or they have no effect.
        UnknownNameError: If there is no such policy or setting.
        RunError: If the folder is no run, or damaged.
        PluginError: If the package that brings it along is broken.
    """
    if name in experts.names():
        _require_no_acting(name, preset, acting)
        return _expert_driver(CollectConfig(expert=experts.known(name)))
    if name is not None and name in plugins.names("policy"):
        _require_no_acting(name, preset, acting)
        return _plugin_driver(name)
    from mjdrive.learning import pilot  # torch takes a second
    from mjdrive.learning import runs as run_folders
    from mjdrive.learning.training import Source
    from models import checkpoint, serialization

    folder, name = _find_run(name, runs, on_note)
    policy = pilot.load(folder, name=name, preset=preset, acting=acting)
    source = config.read_json(Source, folder / run_folders.SOURCE)
    return Driver(
        policy.name,
        settings=serialization.to_json(policy.config),
        digest=store.digest((folder / checkpoint.MODEL).read_bytes()),
        pilot=policy,
        device=str(policy.device),
        learnt_cars=source.cars,
    )


def _require_no_acting(name: str, preset: str | None, acting: Sequence[str]) -> None:
    """Refuse changes to how a trained policy acts where there is none."""
    given = ([] if preset is None else [f"--preset {preset}"]) + [f"--set {it}" for it in acting]
    if given:
        raise ConfigError(
            f"{given[0]} has no effect on '{name}', which mjdrive has not trained. Leave it out, or name a trained policy."
        )


def _find_run(
    name: str | None, runs: Path, on_note: Callable[[str], None]
) -> tuple[Path, str | None]:
    """Folder of a trained policy, and what it is called if not as its folder."""
    from mjdrive.learning import runs as run_folders
    from mjdrive.zoo import entries

    if name is None:
        newest = run_folders.newest(runs)
        if newest is not None:
            return newest, None
        name = entries.PREFIX + entries.DEFAULT
        on_note(f"There is no trained run in '{runs}', so {name} drives, which comes with mjdrive.")
    if name.startswith(entries.PREFIX):
        return entries.find(name), name
    others = (*entries.full_names(), *plugins.names("policy"), *plugins.names("expert"))
    return run_folders.find(name, runs, others=others), None


def _expert_driver(expert: CollectConfig) -> Driver:
    if expert.expert not in experts.NAMES:
        return Driver(expert.expert, settings=_origin("expert", expert.expert), expert=expert)
    settings = expert.pid if expert.expert == "pid" else expert.mpc
    return Driver(expert.expert, settings=config.to_json(settings), expert=expert)


def _plugin_driver(name: str) -> Driver:
    """A policy that another package brings along."""
    policy = plugged.make_policy(name)
    return Driver(policy.name, settings=_origin("policy", name), pilot=policy)


def _origin(kind: plugins.Kind, name: str) -> str:
    """What can be said of the settings of a plug-in: who brought it along."""
    return json.dumps({"package": plugins.source(kind, name)})
