"""The bird's-eye view against pictures that MuJoCo takes of the same roads: a wholly different path.

What is compared. The projector draws a raster with OpenCV once and turns it into views. Here the ground is cut out of
the lanes by shapely instead, becomes triangle meshes, and an orthographic camera straight above looks at them with
`mjRND_SEGMENT`, so each pixel says which mesh it sees. No line of code is shared but the lanes themselves.

- Road: each lane, widened on all sides by half of the outline: a street of 8.0 m becomes the 9.0 m of the paper's
  renderer, which is the default (5 px = 1.0 m), and 9.4 m with 7 px.
- Lane lines: both edges of every lane outside junctions, one pixel (0.2 m) wide and unbroken. (The scene that people
  look at has broken centre lines only, as its map says; no policy sees those.)
- A pixel of the view is on where any part of it is touched. So pictures are taken at 15 px/m, and a pixel of 5 px/m is
  on where one of its 3 x 3 samples is. MuJoCo's edges are not rounded to pixels; the projector rounds twice: that is
  all the bars leave room for, and why lane lines, 1 px wide, are widened by a pixel on both sides before they meet.

The last test takes the scene as it is driven in, where the asphalt reaches 0.3 m beyond the lanes: the projector is
told so by an outline of 3 px.
"""

import cv2
import mujoco
import numpy as np
import pytest
import shapely

from mjdrive.bev.layers import Layer
from mjdrive.bev.projector import BevProjector
from mjdrive.config import BevConfig
from mjdrive.datatypes import Lane, Town
from mjdrive.simulation.scene import build_scene
from mjdrive.town import library

POSES = 200  # a town
PIXEL = 0.2  # [m]
SIMPLER = 0.005  # a curve may move by this, for fewer triangles [m]

ROADS = {"road": 5, "wide_road": 7}  # width of the outline [px], narrower above wider

pytestmark = pytest.mark.slow

Pose = tuple[float, float, float]


def lane_edges(lane: Lane) -> tuple[np.ndarray, np.ndarray]:
    """Left and right edge, with normals as complex numbers: the mean direction of the two neighbouring segments."""
    line = lane.centerline @ np.array([1, 1j])
    direction = np.diff(line) / np.abs(np.diff(line))
    mean = np.concatenate([direction[:1], direction[1:] + direction[:-1], direction[-1:]])
    width = lane.width if lane.widths is None else lane.widths
    out = 0.5 * width * 1j * mean / np.abs(mean)
    return tuple(np.column_stack([edge.real, edge.imag]) for edge in (line + out, line - out))


def lane_area(lane: Lane) -> shapely.Geometry:
    left, right = lane_edges(lane)
    quads = np.stack([left[:-1], right[:-1], right[1:], left[1:]], axis=1)
    return shapely.union_all(shapely.make_valid(shapely.polygons(quads)))


def add_mesh(spec: mujoco.MjSpec, name: str, areas: object, height: float) -> None:
    triangles = shapely.get_parts(shapely.constrained_delaunay_triangles(areas))
    rings = shapely.get_coordinates(shapely.orient_polygons(triangles)).reshape(-1, 4, 2)
    points, faces = np.unique(rings[:, :3].reshape(-1, 2), axis=0, return_inverse=True)
    spec.add_mesh(
        name=name,
        uservert=np.column_stack([points, np.full(len(points), height)]).ravel().tolist(),
        userface=faces.ravel().tolist(),
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )
    geom = spec.worldbody.add_geom(name=name, type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name)
    geom.contype = geom.conaffinity = 0


def model_of_roads(town: Town) -> mujoco.MjModel:
    lanes = town.lanes.values()
    areas = np.array([lane_area(lane) for lane in lanes])
    edges = [edge for lane in lanes if lane.junction is None for edge in lane_edges(lane)]
    lines = [shapely.LineString(edge).buffer(0.5 * PIXEL, cap_style="square") for edge in edges]
    spec = mujoco.MjSpec()
    for height, (name, outline_px) in enumerate(ROADS.items()):
        wide = shapely.buffer(areas, 0.5 * outline_px * PIXEL)
        add_mesh(spec, name, shapely.simplify(wide, SIMPLER), -0.1 * height)
    add_mesh(spec, "lines", lines, 0.1)
    return spec.compile()


def random_poses(town: Town, count: int, *, seed: int = 0) -> list[Pose]:
    """Anywhere near a lane, looking anywhere."""
    rng = np.random.default_rng(seed)
    points = np.concatenate([lane.centerline for lane in town.lanes.values()])
    spots = points[rng.integers(len(points), size=count)] + rng.normal(0.0, 4.0, (count, 2))
    return [(float(x), float(y), float(rng.uniform(-np.pi, np.pi))) for x, y in spots]


def view(projector: BevProjector, pose: Pose) -> np.ndarray:
    x, y, yaw = pose
    return projector.project(x=x, y=y, yaw=yaw, time=0.0, light_phase=0.0) > 0


def grown(masks: np.ndarray) -> np.ndarray:
    square = np.ones((3, 3), np.uint8)
    return np.array([cv2.dilate(mask.astype(np.uint8), square) > 0 for mask in masks])


def overlap(ours: np.ndarray, theirs: np.ndarray) -> float:
    """Intersection over union of all pictures together."""
    return np.count_nonzero(ours & theirs) / np.count_nonzero(ours | theirs)


@pytest.fixture(scope="module", params=library.shipped_names())
def town(request: pytest.FixtureRequest) -> Town:
    return library.load(request.param)


@pytest.fixture(scope="module")
def pictures(town: Town, look_down) -> tuple[list[Pose], np.ndarray, np.ndarray, np.ndarray]:
    """Poses, and what MuJoCo sees there: the road, one with a wider outline, lane lines."""
    poses = random_poses(town, POSES)
    seen = look_down(model_of_roads(town), poses, "road", "wide_road", "lines")
    road, wide_road, lines = np.moveaxis(seen, 1, 0)
    return poses, road | lines, wide_road | road | lines, lines  # what is above hides what is below


def test_road_and_lane_lines_are_those_that_mujoco_sees(town, pictures):
    poses, road, wide_road, lines = pictures
    projector = BevProjector(town)
    ours = np.array([view(projector, pose) for pose in poses])
    assert overlap(ours[:, Layer.ROAD], road) >= 0.98
    assert overlap(grown(ours[:, Layer.LANE_LINES]), grown(lines)) >= 0.85
    wide = BevProjector(town, config=BevConfig(road_outline_px=7))
    ours = np.array([view(wide, pose) for pose in poses])
    assert overlap(ours[:, Layer.ROAD], wide_road) >= 0.98


@pytest.mark.parametrize(
    "mistake",
    [
        lambda bev: np.roll(bev, 2, axis=-1),
        lambda bev: np.roll(bev, 2, axis=-2),
        lambda bev: bev[..., ::-1],
        lambda bev: bev[..., ::-1, :],
    ],
    ids=["2 px aside", "2 px ahead", "left is right", "front is back"],
)
def test_comparison_sees_mistakes_of_the_view(town, pictures, mistake):
    poses, road, _, lines = pictures
    projector = BevProjector(town)
    ours = np.array([mistake(view(projector, pose)) for pose in poses])
    assert overlap(ours[:, Layer.ROAD], road) < 0.96
    assert overlap(grown(ours[:, Layer.LANE_LINES]), grown(lines)) < 0.65


@pytest.mark.parametrize(
    "mistake",
    [
        lambda x, y, yaw: (x, y, -yaw),
        lambda x, y, yaw: (x, y, yaw + 0.05),
        lambda x, y, yaw: (x + 1.35 * np.cos(yaw), y + 1.35 * np.sin(yaw), yaw),
        lambda x, y, yaw: (x, -y, yaw),
    ],
    ids=["yaw clockwise", "yaw off by 3 degrees", "car's middle for rear axle", "y to the south"],
)
def test_comparison_sees_mistakes_of_the_pose(town, pictures, mistake):
    poses, road, _, lines = pictures
    projector = BevProjector(town)
    ours = np.array([view(projector, mistake(*pose)) for pose in poses])
    assert overlap(ours[:, Layer.ROAD], road) < 0.96
    assert overlap(grown(ours[:, Layer.LANE_LINES]), grown(lines)) < 0.65


def test_asphalt_of_the_scene_is_the_road_of_the_view(town, look_down):
    scene = build_scene(town, library.load_settings(town.name), timestep=0.005).compile()
    asphalt = scene.geom("asphalt").id
    scene.geom_group[:] = 5  # not shown: cars, signs and trees hang over the road
    scene.geom_group[asphalt] = 0
    poses = random_poses(town, 60, seed=1)
    projector = BevProjector(town, config=BevConfig(road_outline_px=3))
    ours = np.array([view(projector, pose)[Layer.ROAD] for pose in poses])
    assert overlap(ours, look_down(scene, poses, "asphalt")[:, 0]) >= 0.98
