"""What is driven: one simulation, one policy, and the drive so far. No threads and no network here."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Action, Infraction, Observation
from mjdrive.page.scene import scene_message
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from mjdrive.web.choices import load_mind
from mjdrive.web.policies import Mind
from mjdrive.web.recording import Recording, keep, require_room

MOST_ROWS = 36_000
"""Of a drive that are remembered for pages that come later [-]."""

LATEST_ROWS = 64
"""That each panel brings, so that a page which misses some has the whole drive [-]."""

MOST_INFRACTIONS = 200
"""That are told to pages, the newest ones [-]."""


@dataclass(frozen=True, slots=True)
class Choice:
    """What to drive.

    Attributes:
        town: Name of the town.
        policy: Name of the policy.
        seed: Of the drive [-].
    """

    town: str
    policy: str
    seed: int


@dataclass(frozen=True, slots=True)
class Decision:
    """What the policy makes of the situation now.

    Attributes:
        tick: Control steps since reset [-].
        observation: What it sees.
        action: What it would do; None if it was not asked, or has failed while a person drives.
    """

    tick: int
    observation: Observation
    action: Action | None


@dataclass
class Session:
    """A drive that goes on, step by step.

    Attributes:
        choice: What is driven.
        runs: Folder of run folders.
        data: Folder of data sets, for what people drive.
        on_progress: Told in a line what takes a while.
    """

    choice: Choice
    runs: Path
    data: Path
    on_progress: Callable[[str], None] = lambda line: None
    infractions: list[Infraction] = field(default_factory=list, init=False)

    def __post_init__(self) -> None:
        self.simulation, self.mind = self._loaded(self.choice)
        self.scene = scene_message(self.simulation.town, self.simulation.model)
        self.recording: Recording | None = None
        self.reset()

    def load(self, choice: Choice) -> bool:
        """Drive something else; whether the scene is another one. What was driven by hand is kept first.

        Raises:
            MjdriveError: If there is no such thing, or what was driven cannot be kept; then all stays as it was.
        """
        self.keep_what_is_left()
        simulation, mind = self._loaded(choice)
        mind.begin(simulation, choice.seed)
        is_new = simulation is not self.simulation
        if is_new:
            self.scene = scene_message(simulation.town, simulation.model)
        self.choice, self.simulation, self.mind = choice, simulation, mind
        self.reset()
        return is_new

    def reset(self) -> None:
        """Start the drive again; what was driven by hand until now is kept first.

        Raises:
            DataError: If it cannot be kept; then the drive goes on.
        """
        self.keep_what_is_left()
        self.mind.begin(self.simulation, self.choice.seed)
        self.infractions.clear()
        self._rows: list[tuple[float, ...]] = []
        self._tick = 0
        self.drop_recording()

    def look(self) -> Decision:
        """Look alone, where the policy cannot be asked."""
        return Decision(self._tick, self.simulation.observe(), None)

    def decide(self) -> Decision:
        """Let the policy look and choose."""
        observation = self.simulation.observe()
        return Decision(self._tick, observation, self.mind.decide(self.simulation, observation))

    def step(
        self, action: Action, *, on_motion: Callable[[], None], by_hand: bool = False
    ) -> tuple[Infraction, ...]:
        """Drive for one control interval.

        Args:
            action: What to do.
            on_motion: Called some fifty times a second of the simulation.
            by_hand: Whether a person chose the action; only that is recorded.

        Raises:
            PhysicsError: If the physics has become unstable.
        """
        self._remember(action)
        recording = self.recording if by_hand else None
        if recording is not None and recording.is_full:
            self.keep_recording()
            recording = self.recording
        if recording is not None:
            recording.before(action)
        found = self.simulation.step(action, on_motion=on_motion)
        if recording is not None:
            recording.after(found)
        self._tick += 1
        self.infractions = [*self.infractions, *found][-MOST_INFRACTIONS:]
        return found

    def begin_recording(self) -> None:
        """Record from now on: a person has taken the wheel.

        Raises:
            DataError: If the disk is full, or what was driven before cannot be kept.
        """
        require_room(self.data)
        self.keep_what_is_left()
        self.recording = Recording(self.simulation, self.choice.seed)

    def keep_recording(self) -> Path:
        """Write what was recorded into the data set of drives by hand, and begin anew.

        Raises:
            DataError: If hardly anything was driven, or it cannot be written; then it is still there.
        """
        assert self.recording is not None, "nobody has driven"
        town, car = self.simulation.town, self.simulation.car_model
        folder = self.data / f"human-{town.name}"
        path = keep(self.recording.episode(), folder, town=town, car=car)
        self.drop_recording()
        return path

    def keep_what_is_left(self) -> None:
        """Keep what was driven by hand, if it is worth it, before it would be lost.

        Raises:
            DataError: If it cannot be written; then it is still there.
        """
        if self.recording is not None and self.recording.is_worth_keeping:
            self.on_progress(f"What you drove by hand is kept as {self.keep_recording()}")

    def drop_recording(self) -> None:
        """Forget what was recorded, and begin anew."""
        if self.recording is not None:
            self.recording = Recording(self.simulation, self.choice.seed)

    @property
    def rows(self) -> Float[np.ndarray, "T 6"]:
        """The drive so far: time [s], x, y [m], speed [m/s], acceleration, steering [-]."""
        return np.array(self._rows, np.float64).reshape(-1, 6)

    @property
    def latest_rows(self) -> Float[np.ndarray, "T 6"]:
        """The end of `rows`, `LATEST_ROWS` at most."""
        return np.array(self._rows[-LATEST_ROWS:], np.float64).reshape(-1, 6)

    def _remember(self, action: Action) -> None:
        vehicle = self.simulation.vehicle
        row = (self.simulation.time, vehicle.x, vehicle.y, vehicle.speed)
        self._rows.append((*row, action.acceleration, action.steering))
        if len(self._rows) > MOST_ROWS:
            del self._rows[: MOST_ROWS // 2]

    def _loaded(self, choice: Choice) -> tuple[Simulation, Mind]:
        """Simulation and policy of a choice; what is there already is kept."""
        before = getattr(self, "simulation", None)
        town = library.load(choice.town)
        if before is not None and choice.policy == self.choice.policy:
            mind = self.mind
        else:
            self.on_progress(f"Loading {choice.policy}")
            mind = load_mind(choice.policy, self.runs)
        if before is not None and town.digest == before.town.digest:
            return before, mind
        self.on_progress(f"Building {choice.town}")  # takes seconds: what is refused comes before
        return Simulation(town), mind
