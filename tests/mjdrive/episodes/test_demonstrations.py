import dataclasses
import hashlib
import json
import os
import signal
from multiprocessing.context import SpawnProcess
from pathlib import Path

import casadi
import numpy as np
import pytest

from mjdrive.config import CollectConfig, DisturbanceConfig
from mjdrive.datatypes import Route, Signal, Town
from mjdrive.episodes import collector, dataset, demonstrations
from mjdrive.episodes.manifest import Manifest
from mjdrive.errors import DataError, MjdriveError, RouteError, WorkerError
from mjdrive.execution import pool
from mjdrive.execution.executors import executor_for
from mjdrive.expert.solves import OUTCOMES
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import routing

TWICE = CollectConfig(repeats=2)


@pytest.fixture(autouse=True)
def one_scene(simulation: Simulation, monkeypatch: pytest.MonkeyPatch) -> None:
    """This process drives in the scene that is there, which saves seconds; other processes build their own."""
    monkeypatch.setattr(collector, "Simulation", lambda town, *, car: simulation)


@pytest.fixture(scope="module")
def routes(town02: Town) -> dict[str, Route]:
    rng = np.random.default_rng(4)
    lane, station = routing.random_start(town02, rng)
    route = routing.random_route(town02, lane=lane, station=station, length=20.0, rng=rng)
    return {"short": route}


def digests(folder: Path) -> dict[str, str]:
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.iterdir()}


def collect(
    town: Town,
    routes: dict[str, Route],
    folder: Path,
    settings: CollectConfig = TWICE,
    *,
    jobs: int = 1,
    mix: bool = False,
    overwrite: bool = False,
) -> Manifest:
    return demonstrations.collect(
        town,
        routes,
        folder,
        settings=settings,
        seed=0,
        executor=executor_for(jobs=jobs),
        mix=mix,
        overwrite=overwrite,
    )


def test_repeats_differ_and_progress_ends_at_the_steps(
    town02: Town, routes: dict[str, Route], tmp_path: Path
) -> None:
    told: dict[str, tuple[int, int]] = {}
    manifest = demonstrations.collect(
        town02,
        routes,
        tmp_path,
        settings=TWICE,
        seed=0,
        report=lambda name, done, expected: told.update({name: (done, expected)}),
    )
    assert [entry.name for entry in manifest.episodes] == ["short-0", "short-1"]
    assert told == {entry.name: (entry.steps, entry.steps) for entry in manifest.episodes}
    assert manifest == dataset.read_manifest(tmp_path)
    first, second = dataset.read_dataset(tmp_path)[1]
    assert first.seed != second.seed
    assert first.light_phase != second.light_phase
    assert first.metadata["town_digest"] == town02.digest


def test_files_do_not_depend_on_the_number_of_processes(
    town02: Town, routes: dict[str, Route], tmp_path: Path
) -> None:
    settings = CollectConfig(episodes=3)
    told: list[str] = []
    collect(town02, routes, tmp_path / "one", settings)
    demonstrations.collect(
        town02,
        routes,
        tmp_path / "three",
        settings=settings,
        seed=0,
        executor=executor_for(jobs=3),
        report=lambda name, done, expected: told.append(name),
    )
    assert digests(tmp_path / "one") == digests(tmp_path / "three")
    assert set(told) == {"short-0", "short-1", "short-2"}


@pytest.mark.parametrize("is_gone_at_hand_out", [False, True])
def test_killed_process_is_told_and_the_rest_goes_on_later(
    town02: Town,
    routes: dict[str, Route],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    is_gone_at_hand_out: bool,
) -> None:
    start = pool._start

    def start_and_kill(processes: list[SpawnProcess]) -> object:
        connection = start(processes)
        pid = processes[-1].pid
        assert pid is not None
        os.kill(pid, signal.SIGKILL)
        if is_gone_at_hand_out:
            processes[-1].join()
        return connection

    monkeypatch.setattr(pool, "_start", start_and_kill)
    with pytest.raises(WorkerError, match=r"'short-\d' was ended from outside.*fewer --jobs"):
        collect(town02, routes, tmp_path, jobs=2)
    assert digests(tmp_path) == {}
    assert len(collect(town02, routes, tmp_path).episodes) == 2


def test_error_of_a_process_is_the_same_as_without(
    town02: Town, routes: dict[str, Route], tmp_path: Path
) -> None:
    hopeless = dataclasses.replace(
        TWICE, disturbance=DisturbanceConfig(stop_rate_per_min=600.0, stop_brake=1.0)
    )
    messages = []
    for jobs in (1, 2):
        with pytest.raises(RouteError, match="Expected it to arrive") as refused:
            collect(town02, routes, tmp_path / str(jobs), hopeless, jobs=jobs)
        messages.append(str(refused.value))
    assert messages[0] == messages[1]


def test_damaged_episode_is_driven_again(
    town02: Town, routes: dict[str, Route], tmp_path: Path
) -> None:
    collect(town02, routes, tmp_path)
    before = digests(tmp_path)
    (tmp_path / "short-0.hdf5").write_bytes(b"damaged")
    collect(town02, routes, tmp_path)
    assert digests(tmp_path) == before


def test_mixed_data_set_keeps_what_was_there_and_can_be_read(
    town02: Town, routes: dict[str, Route], tmp_path: Path
) -> None:
    collect(town02, routes, tmp_path)
    before = digests(tmp_path)
    clean = dataclasses.replace(TWICE, disturbance=None, episodes=1)
    with pytest.raises(DataError, match=r"settings \(disturbance, episodes\)"):
        collect(town02, routes, tmp_path, clean)
    assert digests(tmp_path) == before
    collect(town02, routes, tmp_path, clean, mix=True)
    after = digests(tmp_path)
    assert {name: after[name] for name in before if name.endswith("hdf5")} == {
        name: digest for name, digest in before.items() if name.endswith("hdf5")
    }
    manifest, episodes = dataset.read_dataset(tmp_path)
    assert [entry.name for entry in manifest.episodes] == ["short-0", "short-1", "short-0-mix1"]
    assert [entry.collection for entry in manifest.episodes] == [0, 0, 1]
    assert manifest.collections[1].settings["disturbance"] is None
    assert (episodes[2].actions == episodes[2].labels).all()
    collect(town02, routes, tmp_path)  # each goes on where it is
    collect(town02, routes, tmp_path, clean)
    assert digests(tmp_path) == after


def test_random_walk_needs_no_routes_and_has_its_length(town02: Town, tmp_path: Path) -> None:
    settings = CollectConfig(random_walk_km=0.12, episodes=2)
    manifest = collect(town02, {}, tmp_path, settings)
    assert [entry.name for entry in manifest.episodes] == ["walk-0", "walk-1"]
    for episode in dataset.read_dataset(tmp_path)[1]:
        path = np.hypot(*np.diff(episode.vehicle[:, :2], axis=0).T).sum()
        assert path == pytest.approx(60.0, abs=3.0)


def test_light_that_never_turns_green_is_refused_before_anything_is_driven(
    town02: Town, tmp_path: Path
) -> None:
    light = next(iter(town02.lights.values()))
    red = dataclasses.replace(light, program=((Signal.RED, 30.0), (Signal.GREEN, 0.0)))
    town = dataclasses.replace(town02, lights={**town02.lights, light.id: red})
    after = town.lanes[town.lanes[light.lane].successors[0]]
    points = np.array([town.lanes[light.lane].centerline[0], after.centerline[-1]])
    past = {"past": routing.route_through(town, points)}
    for jobs in (1, 2):
        for overwrite in (False, True):
            with pytest.raises(RouteError, match=rf"Light '{light.id}' .* never turns green"):
                collect(town, past, tmp_path / "data", jobs=jobs, overwrite=overwrite)
    with pytest.raises(RouteError, match="never turns green"):
        collect(town, {}, tmp_path / "data", CollectConfig(random_walk_km=0.1))
    assert not (tmp_path / "data").exists()


def test_foreign_episodes_are_not_overwritten(
    town02: Town, routes: dict[str, Route], tmp_path: Path
) -> None:
    (tmp_path / "short-0.hdf5").write_bytes(b"mine")
    with pytest.raises(DataError, match="is no data set"):
        collect(town02, routes, tmp_path)
    assert (tmp_path / "short-0.hdf5").read_bytes() == b"mine"


def test_settings_of_an_expert_that_does_not_drive_are_left_out() -> None:
    assert "mpc" not in demonstrations.described(CollectConfig())
    assert "mpc" in demonstrations.described(CollectConfig(expert="mpc"))


def test_overwriting_replaces_another_data_set_and_leaves_strangers_alone(
    town02: Town, routes: dict[str, Route], tmp_path: Path
) -> None:
    collect(town02, routes, tmp_path / "new", CollectConfig(episodes=1))
    collect(town02, routes, tmp_path / "old")
    (tmp_path / "old/notes.hdf5").write_bytes(b"mine")
    collect(town02, routes, tmp_path / "old", CollectConfig(episodes=1), overwrite=True)
    assert (tmp_path / "old/notes.hdf5").read_bytes() == b"mine"
    (tmp_path / "old/notes.hdf5").unlink()
    assert digests(tmp_path / "old") == digests(tmp_path / "new")


def test_overwriting_the_same_data_set_drives_it_again(
    town02: Town, routes: dict[str, Route], tmp_path: Path
) -> None:
    told: list[int] = []
    for _ in range(2):
        demonstrations.collect(
            town02,
            routes,
            tmp_path,
            settings=TWICE,
            seed=0,
            overwrite=True,
            on_late_plans=told.append,
        )
    assert told == [0] * 4


def test_refused_overwriting_leaves_the_data_set_as_it_was(
    town02: Town, routes: dict[str, Route], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    collect(town02, routes, tmp_path)
    before = digests(tmp_path)
    lights = {
        name: dataclasses.replace(light, program=((Signal.RED, 30.0), (Signal.GREEN, 0.0)))
        for name, light in town02.lights.items()
    }
    stuck = dataclasses.replace(town02, lights=lights)
    hopeless = DisturbanceConfig(stop_rate_per_min=600.0, stop_brake=1.0)
    monkeypatch.setattr(casadi, "has_nlpsol", lambda name: False)
    for town, settings, message in (
        (town02, CollectConfig(expert="mpc"), "lacks plug-ins for the MPC expert"),
        (stuck, CollectConfig(random_walk_km=0.1), "never turns green"),
        (town02, CollectConfig(disturbance=hopeless), "Expected it to arrive"),
    ):
        with pytest.raises(MjdriveError, match=message):
            collect(town, routes, tmp_path, settings, overwrite=True)
        assert digests(tmp_path) == before, message


def test_solves_are_told_of_each_episode_and_not_of_an_expert_that_solves_nothing(
    town02: Town, routes: dict[str, Route], tmp_path: Path
) -> None:
    for jobs in (1, 2):
        collect(
            town02,
            routes,
            tmp_path / str(jobs),
            dataclasses.replace(TWICE, expert="mpc"),
            jobs=jobs,
        )
    assert digests(tmp_path / "1") == digests(tmp_path / "2")
    manifest, episodes = dataset.read_dataset(tmp_path / "1")
    for entry, episode in zip(manifest.episodes, episodes, strict=True):
        assert entry.solver == episode.metadata["solver"] == "fatrop"
        assert entry.solves == json.loads(episode.metadata["solves"])
        assert set(entry.solves) == set(OUTCOMES)
        assert 0 < sum(entry.solves.values()) <= entry.steps
    (plain,) = collect(town02, routes, tmp_path / "pid", CollectConfig()).episodes
    assert (plain.solver, plain.solves) == ("", {})
