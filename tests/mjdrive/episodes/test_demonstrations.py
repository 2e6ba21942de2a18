from pathlib import Path

import numpy as np
import pytest

from mjdrive.config import CollectConfig
from mjdrive.datatypes import Route, Town
from mjdrive.episodes import dataset, demonstrations
from mjdrive.errors import DataError, RouteError, UnknownNameError
from mjdrive.town import routing


@pytest.fixture(scope="module")
def routes(town02: Town) -> dict[str, Route]:
    rng = np.random.default_rng(4)
    lane, station = routing.random_start(town02, rng)
    route = routing.random_route(town02, lane=lane, station=station, length=20.0, rng=rng)
    return {"short": route}


def test_repeats_differ_and_progress_ends_at_the_steps(
    town02: Town, routes: dict[str, Route], tmp_path: Path
) -> None:
    told: dict[str, tuple[int, int]] = {}
    manifest = demonstrations.collect(
        town02,
        routes,
        tmp_path,
        settings=CollectConfig(repeats=2),
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


def test_unknown_route_is_refused(town02: Town, routes: dict[str, Route], tmp_path: Path) -> None:
    with pytest.raises(UnknownNameError, match=r"route of town02 'shrt'.*Did you mean 'short'"):
        demonstrations.collect(
            town02, routes, tmp_path, settings=CollectConfig(routes=("shrt",)), seed=0
        )


def test_town_without_routes_is_refused(town02: Town, tmp_path: Path) -> None:
    with pytest.raises(RouteError, match="'town02' has no routes"):
        demonstrations.collect(town02, {}, tmp_path, settings=CollectConfig(), seed=0)


def test_foreign_episodes_are_not_overwritten(
    town02: Town, routes: dict[str, Route], tmp_path: Path
) -> None:
    (tmp_path / "short-0.hdf5").write_bytes(b"mine")
    with pytest.raises(DataError, match="is no data set"):
        demonstrations.collect(town02, routes, tmp_path, settings=CollectConfig(), seed=0)
    assert (tmp_path / "short-0.hdf5").read_bytes() == b"mine"
