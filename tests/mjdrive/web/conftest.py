"""A session without network, and a simulator that is turned by hand, with an audience that notes what it is told."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from hatchling.builders.wheel import WheelBuilder

from mjdrive.datatypes import Episode, Infraction, InfractionKind
from mjdrive.episodes import store
from mjdrive.vehicle import cars
from mjdrive.vehicle.assembly import car_on_road
from mjdrive.vehicle.car import Car
from mjdrive.web.commands import Command
from mjdrive.web.pace import Pace
from mjdrive.web.roles import Standing
from mjdrive.web.session import Choice, Session
from mjdrive.web.simulator import Simulator
from mjdrive.zoo import entries

ROOT = Path(__file__).resolve().parents[3]
TOWN = "town03"
FLAWS = ("collisions", "kerb_strikes", "road_departures", "wrong_ways", "standstills")


class Notebook:
    """Notes all that pages would be told."""

    is_open = is_watching = True

    def __init__(self) -> None:
        self.told: list[tuple[str, bytes]] = []
        self.lines: list[tuple[str, object | None]] = []
        self.values: dict[str, Any] = {}
        self.standing = Standing()

    def tell(self, kind: str, message: bytes) -> None:
        self.told.append((kind, message))

    def tell_state(self, values: dict[str, Any], standing: Standing) -> None:
        self.values, self.standing = values, standing

    def note(self, line: str, *, is_error: bool = False, to: object | None = None) -> None:
        del is_error
        self.lines.append((line, to))

    def heard(self, words: str, *, by: object | None = None) -> bool:
        """Whether a line with these words was told to one, or to all."""
        return any(words in line and to is by for line, to in self.lines)


class Desk:
    """A simulator, what it told, and pages that talk to it; it turns when it is asked to."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.notebook = Notebook()
        self.pace = Pace(sleep=lambda duration: None)
        self.simulator = Simulator(session, self.notebook, self.pace)

    def come(self, who: str) -> None:
        self.simulator.inbox.come(who)
        self.simulator.turn()

    def leave(self, who: str) -> None:
        self.simulator.inbox.leave(who)
        self.simulator.turn()

    def say(self, who: str, op: str, **values: Any) -> None:
        assert self.simulator.inbox.put(Command(op, values), who)
        self.simulator.turn()

    def turn(self, count: int) -> None:
        for _ in range(count):
            self.simulator.turn()

    @property
    def kept(self) -> list[Path]:
        """What was driven by hand, on the disk."""
        return sorted(self.session.data.glob("**/human-*.hdf5"))


@pytest.fixture(scope="session")
def built(tmp_path_factory: pytest.TempPathFactory) -> Session:
    """One session for all: towns take seconds to build."""
    folder = tmp_path_factory.mktemp("built")
    return Session(Choice(TOWN, "pid", 0), runs=folder / "runs", data=folder / "data")


@pytest.fixture
def session(built: Session, tmp_path: Path) -> Iterator[Session]:
    """The session as it was at the start, with folders of its own."""
    mind, choice = built.mind, built.choice
    built.runs, built.data = tmp_path / "runs", tmp_path / "data"
    built.recording = None
    built.on_progress = lambda line: None
    built.reset()
    yield built
    built.mind, built.choice, built.recording = mind, choice, None


@pytest.fixture
def desk(session: Session) -> Desk:
    desk = Desk(session)
    desk.come("first")
    return desk


@pytest.fixture(scope="session")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the installed wheel, to be put first in PYTHONPATH."""
    folder = tmp_path_factory.mktemp("installed")
    (wheel,) = WheelBuilder(str(ROOT)).build(directory=str(folder), versions=["standard"])
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index"]
    command += ["--disable-pip-version-check", "--target", str(folder / "site"), wheel]
    subprocess.run(command, check=True)
    return folder / "site"


@pytest.fixture(scope="session")
def environment(installed: Path) -> dict[str, str]:
    """Where only the wheel, and never the checkout, is found."""
    kept = [it for it in os.environ.get("PYTHONPATH", "").split(os.pathsep) if it]
    others = [it for it in kept if Path(it).resolve() != ROOT]
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(installed), *others])}


def straight_episode() -> Episode:
    """Straight on along x at 10 m/s, with an infraction after two seconds, when lights turn yellow, too."""
    steps = 60
    model = car_on_road(timestep=0.005, car=cars.load(cars.DEFAULT).path).compile()
    physics = Car(model, mujoco.MjData(model)).save()
    vehicle = np.zeros((steps, 6))
    vehicle[:, 0], vehicle[:, 3] = np.arange(steps), 10.0
    actions = np.tile([0.5, -0.25], (steps, 1))
    return Episode(
        town="town03",
        policy="searcher",
        seed=7,
        light_phase=8.0,
        time=0.1 * np.arange(steps),
        physics=np.tile(physics, (steps, 1)),
        vehicle=vehicle,
        actions=actions,
        labels=actions,
        on_lane=np.ones(steps, bool),
        infractions=(Infraction(InfractionKind.KERB, 2.0, 20.0, 0.0, "kerb/1"),),
        metadata={},
    )


@pytest.fixture(scope="session")
def shelves(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the server is started: a run whose policy searches in three iterations, and two drives of it."""
    folder = tmp_path_factory.mktemp("shelves")
    run = folder / "runs" / "searcher"
    shutil.copytree(entries.find("zoo:da-ibc"), run)
    settings = json.loads((run / "config.json").read_text())
    settings["sampler"]["kind"] = "dfo"
    settings["sampler"]["dfo"] |= {"num_samples": 96, "iterations": 3}
    (run / "config.json").write_text(json.dumps(settings))
    lines = [
        json.dumps({"epoch": n, "loss": 1 / n, "validation_loss": 2 / n, "duration_s": 60})
        for n in (1, 2, 3)
    ]
    (run / "metrics.jsonl").write_text("\n".join(lines))
    for number, distance in enumerate((100.0, 300.0)):
        drive = folder / "drives" / f"drive-{number}"
        drive.mkdir(parents=True)
        store.write(straight_episode(), drive / "episode.hdf5")
        figures = {"distance_m": distance, "score": distance, "red_lights": number}
        others = {"policy": "searcher", "town": "town03", **dict.fromkeys(FLAWS, 0)}
        (drive / "summary.json").write_text(json.dumps(figures | others))
    return folder
