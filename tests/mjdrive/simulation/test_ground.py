import mujoco
import numpy as np
import pytest
import shapely

from mjdrive.datatypes import Lane, Town
from mjdrive.simulation.ground import LAND_DEPTH, add_ground
from mjdrive.simulation.palette import add_materials
from mjdrive.simulation.sidewalks import KERB_HEIGHT
from mjdrive.town.scenery import Scenery, lay_out
from mjdrive.town.scenery.layout import KERBSTONE_WIDTH
from mjdrive.town.settings import SceneryConfig

SCENERY = SceneryConfig()


@pytest.fixture
def town() -> Town:
    """A street with a bend."""
    x = np.linspace(0.0, 120.0, 61)
    lane = Lane("a", np.column_stack([x, 0.002 * x**2]), 6.0, (), None, None)
    return Town("bend", {"a": lane}, {}, np.array([0.0, -3.0, 120.0, 32.0]), "")


@pytest.fixture
def layout(town) -> Scenery:
    return lay_out(town, SCENERY)


@pytest.fixture
def spec(town, layout) -> mujoco.MjSpec:
    spec = mujoco.MjSpec()
    add_materials(spec)
    add_ground(spec, town, layout, sidewalk_width=SCENERY.sidewalk_width)
    return spec


def corners(spec: mujoco.MjSpec, name: str) -> np.ndarray:
    mesh = spec.mesh(name)
    return np.array(mesh.uservert).reshape(-1, 3)[np.array(mesh.userface).reshape(-1, 3)]


def flat(spec: mujoco.MjSpec, name: str) -> list[shapely.Polygon]:
    """Plan of the triangles that look to the sky."""
    return [
        shapely.Polygon(triangle[:, :2])
        for triangle in corners(spec, name)
        if np.ptp(triangle[:, 2]) < 1e-6
    ]


def test_asphalt_kerb_verge_and_sidewalk_cover_the_street_once_and_without_gaps(spec, layout):
    parts = [
        triangle
        for name in ("asphalt", "kerbstone", "verge", "sidewalk")
        for triangle in flat(spec, name)
    ]
    covered = shapely.union_all(parts, grid_size=1e-3)
    assert covered.area == pytest.approx(sum(part.area for part in parts), rel=1e-3)
    whole = shapely.union_all([layout.road, layout.verge, layout.sidewalk])
    assert shapely.difference(whole, covered.buffer(0.005)).area < 0.01
    assert not any(
        ring.area > 0.01 for ring in map(shapely.Polygon, covered.buffer(0.005).interiors)
    )


def test_kerb_faces_the_road_and_stands_on_the_land(spec, layout):
    upright = corners(spec, "kerbstone")
    upright = upright[np.ptp(upright[..., 2], axis=1) > 1e-6]
    normals = np.cross(upright[:, 1] - upright[:, 0], upright[:, 2] - upright[:, 0])[:, :2]
    ahead = upright[..., :2].mean(axis=1) + 0.02 * normals / np.hypot(*normals.T)[:, None]
    looks_at_road = shapely.contains_xy(layout.road, *ahead.T)
    inner = shapely.contains_xy(
        layout.road.buffer(0.5 * KERBSTONE_WIDTH), *upright[..., :2].mean(axis=1).T
    )
    assert looks_at_road[inner].all()
    assert not looks_at_road[~inner].any()
    assert upright[..., 2].min() == pytest.approx(LAND_DEPTH)
    assert upright[..., 2].max() == pytest.approx(KERB_HEIGHT)


def test_slabs_that_tyres_feel_are_as_high_as_what_is_seen_and_unseen_themselves(spec):
    model = spec.compile()
    slabs = [
        model.geom(index)
        for index in range(model.ngeom)
        if model.geom(index).name.startswith("kerb_")
    ]
    assert slabs
    for slab in slabs:
        assert slab.pos[2] + slab.size[2] == pytest.approx(KERB_HEIGHT)
        assert slab.group[0] == 3
        assert slab.contype[0]
