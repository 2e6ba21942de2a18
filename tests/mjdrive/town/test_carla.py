"""Hold mjdrive's reading of maps against that of CARLA's own client library, and our towns against CARLA's.

CARLA's maps are compared where MJDRIVE_REFERENCE_MAPS names a folder with Town01.xodr and Town02.xodr.
"""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from mjdrive.town import library, opendrive
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.opendrive.road_shapes import Cubic, Spiral
from mjdrive.town.settings import LightTiming

pytest.importorskip("carla", reason="CARLA's client is installed on Linux on x86-64 only")

SCRIPTS = Path(__file__).parents[3] / "scripts"
FOLDER = os.environ.get("MJDRIVE_REFERENCE_MAPS")
REFERENCES = ["town01", "town02"]
COUNTS = {"town01": (12, 36), "town02": (8, 24)}

needs_references = pytest.mark.skipif(
    FOLDER is None,
    reason="MJDRIVE_REFERENCE_MAPS does not name a folder with CARLA's Town01.xodr and Town02.xodr",
)


@pytest.fixture(scope="module")
def script() -> Iterator[ModuleType]:
    """scripts/compare_with_carla.py, imported as a module."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(SCRIPTS))
        import compare_with_carla  # noqa: PLC0415

        yield compare_with_carla


def _reference(name: str) -> Path:
    return Path(FOLDER or "") / f"{name.capitalize()}.xodr"


def _broken(rows: list) -> list:
    return [row for row in rows if not row.holds]


@pytest.mark.parametrize("name", library.shipped_names())
def test_carla_reads_our_maps_as_we_do(script: ModuleType, name: str) -> None:
    path = library.folder_of(name) / library.MAP_FILE
    ours, theirs = script.read_with_mjdrive(path), script.read_with_carla(path)
    assert theirs.lanes
    assert theirs.followings
    assert _broken(script.compare_readings(ours, theirs)) == []


def _left_hand(maker: Any) -> RoadMap:
    """A bend and a street behind it, with more lanes for one direction, where traffic keeps to the left."""
    lanes = maker.section(2, 1, -1)
    bend = maker.ring("1", 30.0, (0.0, 1.0), links=("", "2:start"), drives_on_left=True)
    (x, y), turned = 30.0 * np.array([np.cos(1.0), np.sin(1.0)]), 1.0 + np.pi / 2
    far = (x + 40.0 * np.cos(turned), y + 40.0 * np.sin(turned))
    street = maker.road("2", ((x, y), far), lanes, links=("1:end", ""), drives_on_left=True)
    return maker.map([replace(bend, sections=(lanes,)), street])


def _lane_drop(maker: Any) -> RoadMap:
    """A street on which a lane appears and another tapers away, along a clothoid, with the lanes shifted."""
    grows = maker.lane(-2, predecessor=None, widths=(Cubic(0.0, 0.0, 0.0, 0.01, -0.0003),))
    ends = maker.lane(2, predecessor=None, widths=(Cubic(0.0, 0.0, 0.1),))
    sections = (
        maker.section(1, -1),
        maker.section(ends, 1, -1, grows, s=20.0),
        maker.section(2, 1, -1, -2, s=50.0),
    )
    road = maker.road("1", ((0, 0), (90, 0)), *sections, lane_offsets=(Cubic(0.0, 1.0, 0.02),))
    bend = replace(road.pieces[0], shape=Spiral(0.0, 0.03))
    return maker.map([replace(road, pieces=(bend,))])


@pytest.mark.parametrize(("draw", "num_lanes"), [(_left_hand, 6), (_lane_drop, 10)])
def test_carla_reads_small_maps_as_we_do(
    script: ModuleType,
    maker: Any,
    tmp_path: Path,
    draw: Callable[[Any], RoadMap],
    num_lanes: int,
) -> None:
    path = tmp_path / "map.xodr"
    path.write_bytes(opendrive.write(draw(maker)))
    ours, theirs = script.read_with_mjdrive(path), script.read_with_carla(path)
    assert len(theirs.lanes) == num_lanes
    assert theirs.followings
    assert _broken(script.compare_readings(ours, theirs)) == []


@needs_references
@pytest.mark.parametrize("name", REFERENCES)
def test_carla_reads_its_own_maps_as_we_do(script: ModuleType, name: str) -> None:
    path = _reference(name)
    ours, theirs = script.read_with_mjdrive(path), script.read_with_carla(path)
    assert (len(theirs.junctions), len(theirs.signals)) == COUNTS[name]
    assert _broken(script.compare_readings(ours, theirs)) == []


@needs_references
@pytest.mark.parametrize("name", REFERENCES)
def test_our_towns_are_like_those_of_carla(script: ModuleType, name: str) -> None:
    ours = script.read_with_mjdrive(library.folder_of(name) / library.MAP_FILE)
    theirs = script.read_with_carla(_reference(name))
    assert (len(ours.junctions), len(ours.signals)) == COUNTS[name]
    assert _broken(script.compare_towns(ours, theirs)) == []


@needs_references
def test_our_lights_stand_and_turn_as_those_of_carla() -> None:
    for name in REFERENCES:
        theirs = build_town(
            opendrive.read(_reference(name)), name=name, timing=LightTiming(), digest=""
        ).lights
        ours = library.load(name).lights
        assert ours.keys() == theirs.keys()
        for light in ours.values():
            other = theirs[light.id]
            assert (light.lane, light.junction) == (other.lane, other.junction)
            assert (light.program, light.offset) == (other.program, other.offset)
            np.testing.assert_allclose(light.stop_line, other.stop_line, atol=0.05)
            np.testing.assert_allclose(light.pole, other.pole, atol=0.4)


@needs_references
def test_town01_is_imported_in_less_than_two_seconds() -> None:
    """In a process of its own: here every shape is checked, which takes longer than the work."""
    program = f"""
import time
from pathlib import Path
from mjdrive.town import opendrive
from mjdrive.town.network import build_town
from mjdrive.town.settings import LightTiming
start = time.process_time()
road_map = opendrive.read(Path({str(_reference("town01"))!r}))
build_town(road_map, name="town01", timing=LightTiming(), digest="")
print(time.process_time() - start)
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert float(done.stdout) < 2.0


def test_the_comparison_finds_what_differs(script: ModuleType) -> None:
    path = library.folder_of("town02") / library.MAP_FILE
    ours = script.read_with_mjdrive(path)
    name = next(iter(ours.lanes))
    key = next(iter(ours.stops))
    moved = replace(ours, lanes={**ours.lanes, name: ours.lanes[name] + np.array([0.0, 0.002])})
    cut = replace(ours, followings=frozenset(list(ours.followings)[1:]))
    late = replace(ours, stops={**ours.stops, key: ours.stops[key] + 0.06})
    fewer = replace(ours, moves=frozenset(list(ours.moves)[1:]))
    assert _broken(script.compare_readings(ours, ours)) == []
    for other, what in (
        (moved, ["lane centres, largest distance", "lane starts and ends"]),
        (cut, ["successors"]),
        (late, ["stop points"]),
        (fewer, ["moves across junctions"]),
    ):
        assert [row.what for row in _broken(script.compare_readings(ours, other))] == what
    far = replace(ours, lanes={k: line + np.array([0.3, 0.3]) for k, line in ours.lanes.items()})
    assert [row.what for row in _broken(script.compare_towns(ours, far))] == ["lane centres, mean"]
