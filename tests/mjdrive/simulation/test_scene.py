import functools
import os
import subprocess
import sys
from dataclasses import replace

import mujoco
import numpy as np
import pytest
import shapely

from mjdrive import geometry
from mjdrive.config import SimulationConfig
from mjdrive.datatypes import Action, Lane, StaticObject, Town
from mjdrive.errors import TownFormatError
from mjdrive.simulation.scene import build_scene, compile_scene, scene_xml
from mjdrive.town import library, surface
from mjdrive.town.scenery.blocks import Block
from mjdrive.town.settings import TownSettings
from mjdrive.vehicle import engine
from mjdrive.vehicle.car import Car

TOWNS = library.shipped_names()
TIMESTEP = SimulationConfig().timestep


@functools.cache
def compiled(name: str) -> mujoco.MjModel:
    return build_scene(library.load(name), library.load_settings(name), timestep=TIMESTEP).compile()


def footprints(model: mujoco.MjModel, prefix: str) -> list[shapely.Polygon]:
    """Ground under every geom whose name starts with the prefix."""
    areas = []
    for index in range(model.ngeom):
        geom = model.geom(index)
        if geom.name.startswith(prefix):
            yaw = 2 * np.arctan2(geom.quat[3], geom.quat[0])
            is_box = geom.type == mujoco.mjtGeom.mjGEOM_BOX
            length, depth = 2 * geom.size[:2] if is_box else 2 * geom.size[[0, 0]]
            areas.append(Block(*geom.pos[:2], yaw, length, depth, 1.0).footprint())
    return areas


@pytest.mark.parametrize("name", TOWNS)
def test_committed_scene_is_what_the_code_makes(name):
    path = library.folder_of(name) / "scene.xml"
    spec = build_scene(library.load(name), library.load_settings(name), timestep=TIMESTEP)
    assert path.read_text() == scene_xml(spec), "run: python scripts/make_scenes.py"


@pytest.mark.parametrize("name", TOWNS)
def test_committed_scene_is_the_same_world(name):
    written = mujoco.MjModel.from_xml_path(str(library.folder_of(name) / "scene.xml"))
    built = compiled(name)
    for field in (
        "body_mass",
        "body_inertia",
        "geom_pos",
        "geom_size",
        "geom_contype",
        "geom_rgba",
        "geom_conaffinity",
        "geom_friction",
        "jnt_range",
        "actuator_gear",
        "pair_friction",
    ):
        assert getattr(written, field) == pytest.approx(getattr(built, field), abs=1e-4), field


@pytest.mark.parametrize("name", TOWNS)
def test_everything_that_stands_belongs_to_the_world_body(name):
    model = compiled(name)
    bodies = {model.body(index).name for index in range(1, model.nbody)}
    assert bodies == {"car", "rack"} | {
        f"{part}_{wheel}" for part in ("knuckle", "wheel") for wheel in ("fl", "fr", "rl", "rr")
    }


@pytest.mark.parametrize("name", TOWNS)
@pytest.mark.parametrize("prefix", ["kerb_", "building_", "pole_", "tree_"])
def test_nothing_stands_on_the_road(name, prefix):
    lanes = surface.driving_surface(library.load(name))
    areas = footprints(compiled(name), prefix)
    assert areas
    assert not np.any(shapely.intersects(areas, lanes))


@pytest.mark.parametrize("name", TOWNS)
def test_houses_leave_the_sidewalk_and_each_other_alone(name):
    width = library.load_settings(name).scenery.sidewalk_width
    sidewalk = shapely.buffer(surface.road_surface(library.load(name)), width)
    houses = footprints(compiled(name), "building_")
    assert not np.any(shapely.intersects(houses, sidewalk))
    assert shapely.union_all(houses).area == pytest.approx(sum(house.area for house in houses))


@pytest.mark.parametrize("name", TOWNS)
def test_kerbs_line_the_whole_road_within_five_centimetres(name):
    edge = surface.road_surface(library.load(name)).boundary
    kerbs = shapely.union_all(footprints(compiled(name), "kerb_"))
    points = shapely.line_interpolate_point(edge, np.arange(0.0, edge.length, 0.5))
    assert max(shapely.distance(points, kerbs)) < 0.05
    assert max(shapely.distance(points, kerbs.boundary)) < 0.05


@pytest.mark.parametrize("name", TOWNS)
def test_every_light_has_a_pole_and_three_lamps(name):
    model, town = compiled(name), library.load(name)
    for light in town.lights.values():
        assert model.geom(f"pole_{light.id}").pos[:2] == pytest.approx(light.pole, abs=1e-3)
        heights = [
            model.geom(f"lamp_{light.id}_{signal}").pos[2] for signal in ("green", "yellow", "red")
        ]
        assert heights == sorted(heights)


@pytest.mark.parametrize("name", TOWNS)
def test_car_on_any_lane_touches_the_road_alone(name):
    model, town = compiled(name), library.load(name)
    data = mujoco.MjData(model)
    car = Car(model, data)
    for lane in town.lanes.values():
        middle = len(lane.centerline) // 2
        car.place(*lane.centerline[middle], float(geometry.headings(lane.centerline)[middle]))
        names = {model.geom(geom).name for geom in data.contact.geom.ravel()}
        assert names == {"road", "tyre_fl", "tyre_fr", "tyre_rl", "tyre_rr"}, lane.id


def pose_before_a_house(model: mujoco.MjModel) -> tuple[float, float, float]:
    """Somewhere on a lane of town02, looking to the right at the middle of a house with nothing in between."""
    houses = footprints(model, "building_")
    others = [area for kind in ("tree_", "pole_", "sign_") for area in footprints(model, kind)]
    for lane in library.load("town02").lanes.values():
        for point, yaw in zip(lane.centerline, geometry.headings(lane.centerline), strict=True):
            right = np.array([np.sin(yaw), -np.cos(yaw)])
            forward = np.array([np.cos(yaw), np.sin(yaw)])
            end = point + 11.0 * right
            front = shapely.LineString([end - 3.0 * forward, end + 3.0 * forward])
            path = shapely.LineString([point, end]).buffer(2.0)
            if shapely.contains(houses, front).any() and not shapely.intersects(others, path).any():
                return (*point.tolist(), geometry.wrap_angle(float(yaw) - np.pi / 2))
    raise AssertionError("no house beside any lane")


def drive_off_the_road(duration: float) -> tuple[set[str], float, float]:
    """Drive straight over the kerb into a house: names touched, last speed, greatest height."""
    model = compiled("town02")
    data = mujoco.MjData(model)
    car = Car(model, data)
    x, y, yaw = pose_before_a_house(model)
    car.place(x, y, yaw, speed=8.0)
    car.command(Action(0.5, 0.0))
    touched: set[str] = set()
    highest = 0.0
    for _ in range(round(duration / 0.02)):
        car.update()
        mujoco.mj_step(model, data, 4)
        touched |= {model.geom(geom).name.split("_")[0] for geom in data.contact.geom.ravel()}
        highest = max(highest, float(data.qpos[2]))
    engine.require_sane(data)
    return touched, car.state().speed, highest


def test_kerb_is_climbed_without_a_jump_and_walls_stop_the_car():
    touched, speed, highest = drive_off_the_road(4.0)
    assert {"kerb", "tyre", "hull", "building"} <= touched
    assert speed < 1.0
    assert highest < 0.5


COLLIDING = {"road", "kerb", "building", "pole", "sign", "tree", "object", "tyre", "hull"}


@pytest.mark.parametrize("name", TOWNS)
def test_what_only_the_eye_needs_collides_with_nothing(name):
    model = compiled(name)
    for index in range(model.ngeom):
        geom = model.geom(index)
        collides = bool(geom.contype[0] or geom.conaffinity[0])
        assert collides == (geom.name.split("_")[0] in COLLIDING), geom.name
        is_mesh_of_town = geom.type[0] == mujoco.mjtGeom.mjGEOM_MESH and geom.bodyid[0] == 0
        assert not (is_mesh_of_town and collides and not geom.name.startswith("object_"))


@pytest.mark.parametrize("name", TOWNS)
def test_decoration_is_fused_into_few_geoms(name):
    model = compiled(name)
    town = library.load(name)
    decoration = [
        index
        for index in range(model.ngeom)
        if model.geom_bodyid[index] == 0 and not model.geom_contype[index]
    ]
    heads_and_lamps = 4 * len(town.lights)
    assert len(decoration) - heads_and_lamps < 40


def bare_street() -> Town:
    """One lane and nothing else: no lights, signs, marks or objects."""
    lane = Lane("a", np.array([[0.0, 0.0], [60.0, 0.0]]), 4.0, (), None, None)
    return Town("bare", {"a": lane}, {}, np.array([0.0, -2.0, 60.0, 2.0]), "")


def names_of(town: Town) -> set[str]:
    model = build_scene(town, TownSettings(), timestep=TIMESTEP).compile()
    return {model.geom(index).name for index in range(model.ngeom)}


def test_street_without_lights_signs_and_paint_can_be_built():
    names = names_of(bare_street())
    assert {"road", "asphalt", "kerb_0", "building_0"} <= names
    assert not any(name.startswith(("lamp", "pole", "sign", "marking", "stop")) for name in names)


def test_scene_that_mujoco_refuses_names_the_town():
    spec = build_scene(bare_street(), TownSettings(), timestep=TIMESTEP)
    spec.worldbody.add_geom(name="odd", type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.0, 0.0, 0.0])
    with pytest.raises(TownFormatError, match=r"cannot build town 'bare'.*odd"):
        compile_scene(spec)


def test_objects_of_the_map_are_obstacles_and_paint_is_not():
    square = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    things = (
        StaticObject("hall", "building", square + np.array([30.0, 12.0]), 5.0),
        StaticObject("oak", "tree", square + np.array([10.0, 8.0]), 6.0),
        StaticObject("zebra", "crosswalk", 2.0 * square + np.array([30.0, 0.0]), 0.0),
    )
    names = names_of(replace(bare_street(), objects=things))
    assert {"object_0_0", "object_tree_0", "crosswalks"} <= names


def test_other_seed_builds_other_houses():
    town, settings = library.load("town02"), library.load_settings("town02")
    reseeded = type(settings)(scenery=type(settings.scenery)(seed=settings.scenery.seed + 1))
    other = build_scene(town, reseeded, timestep=TIMESTEP).compile()
    houses = [area.wkb for area in footprints(compiled("town02"), "building_")]
    assert houses != [area.wkb for area in footprints(other, "building_")]


def test_building_and_driving_a_scene_needs_no_opengl():
    script = (
        "import sys, mujoco\n"
        "from mjdrive.simulation.scene import build_scene\n"
        "from mjdrive.town import library\n"
        "from mjdrive.vehicle.car import Car\n"
        "spec = build_scene(library.load('town02'), library.load_settings('town02'), timestep=0.005)\n"
        "model = spec.compile(); data = mujoco.MjData(model); Car(model, data).place(0, 0, 0)\n"
        "mujoco.mj_step(model, data)\n"
        "print(sorted(name for name in sys.modules if name.split('.')[0] in ('OpenGL', 'glfw')))"
    )
    environment = {**os.environ, "MUJOCO_GL": "disable"}
    result = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True
    )
    assert result.stdout.strip() == "[]"
