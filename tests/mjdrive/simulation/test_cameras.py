import functools

import mujoco
import numpy as np
import pytest

from mjdrive.errors import RenderError, UnknownNameError
from mjdrive.simulation import opengl
from mjdrive.simulation.cameras import Cameras, overview
from mjdrive.simulation.scene import build_scene
from mjdrive.town import library
from mjdrive.vehicle.assembly import car_on_road
from mjdrive.vehicle.car import Car


@functools.cache
def why_no_opengl() -> str:
    try:
        opengl.open_context(8, 8).free()
    except RenderError as error:
        return str(error)
    return ""


@pytest.fixture
def needs_opengl() -> None:
    if why_no_opengl():
        pytest.skip(why_no_opengl())


@pytest.fixture
def scene() -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = car_on_road(timestep=0.005).compile()
    data = mujoco.MjData(model)
    Car(model, data).place(0.0, 0.0, 0.0)
    return model, data


def is_car_paint(picture: np.ndarray) -> np.ndarray:
    # Whatever the light, paint keeps its ratio of red.
    red, green, blue = np.moveaxis(picture.astype(int), -1, 0)
    return (red > 2 * green) & (red > 2 * blue) & (red > 15)


@pytest.mark.usefixtures("needs_opengl")
@pytest.mark.parametrize("view", ["hood", "chase", "top"])
def test_every_camera_of_the_car_sees_the_car(scene, view):
    model, data = scene
    with Cameras(model, width=320, height=240) as cameras:
        picture = cameras.render(data, view)
    assert picture.shape == (240, 320, 3)
    assert is_car_paint(picture).sum() > 10


@pytest.mark.usefixtures("needs_opengl")
def test_top_camera_has_east_on_the_right_and_north_above(scene):
    model, data = scene
    Car(model, data).place(100.0, 50.0, 0.0)
    marker = mujoco.MjvCamera()
    marker.lookat, marker.distance, marker.azimuth, marker.elevation = [95, 45, 0], 30, 90, -90
    with Cameras(model, width=100, height=100) as cameras:
        rows, columns = np.nonzero(is_car_paint(cameras.render(data, marker)))
    assert rows.mean() < 50 < columns.mean()


@pytest.mark.usefixtures("needs_opengl")
def test_same_state_gives_the_same_picture(scene):
    model, data = scene
    with Cameras(model, width=64, height=48) as cameras:
        first = cameras.render(data, "chase")
        cameras.render(data, "top")
        assert np.array_equal(cameras.render(data, "chase"), first)


@pytest.mark.usefixtures("needs_opengl")
def test_overview_shows_the_whole_town_within_the_frame():
    town = library.load("town02")
    model = build_scene(town, library.load_settings("town02"), timestep=0.005).compile()
    data = mujoco.MjData(model)
    with Cameras(model, width=160, height=120) as cameras:
        for x, y in town.bounds.reshape(2, 2):
            Car(model, data).place(x, y, 0.0)
            with_car = cameras.render(data, overview(town), shadows=False)
            Car(model, data).place(0.0, 1e4, 0.0)
            assert np.any(with_car != cameras.render(data, overview(town), shadows=False))


@pytest.mark.usefixtures("needs_opengl")
def test_unknown_camera_is_refused_with_the_nearest_name(scene):
    model, data = scene
    with (
        Cameras(model, width=8, height=8) as cameras,
        pytest.raises(UnknownNameError, match="Did you mean 'chase'"),
    ):
        cameras.render(data, "chaise")


def test_picture_larger_than_the_scene_allows_is_refused(scene):
    with pytest.raises(RenderError, match="at most 640 x 480"):
        Cameras(scene[0], width=641, height=8)


def test_machine_without_opengl_is_told_what_to_install(scene, monkeypatch):
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.setattr(opengl.platform, "system", lambda: "Linux")
    monkeypatch.setattr(opengl.ctypes.util, "find_library", lambda name: None)
    with pytest.raises(RenderError, match="apt-get install libegl1"):
        Cameras(scene[0], width=8, height=8)


def test_disabled_rendering_is_named_as_the_reason(scene, monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "disable")
    with pytest.raises(RenderError, match="MUJOCO_GL=disable"):
        Cameras(scene[0], width=8, height=8)


def test_installed_osmesa_serves_where_egl_is_missing(monkeypatch):
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.setattr(opengl.platform, "system", lambda: "Linux")
    monkeypatch.setattr(opengl.ctypes.util, "find_library", {"OSMesa": "libOSMesa.so.8"}.get)
    assert opengl.choose_backend() == "osmesa"
