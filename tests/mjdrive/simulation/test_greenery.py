import mujoco
import numpy as np
import pytest

from mjdrive.simulation.greenery import add_trees
from mjdrive.simulation.palette import add_materials
from mjdrive.town.scenery.street_trees import CROWN_SHARE, Tree

TREE = Tree(x=40.0, y=-7.0, height=6.0, trunk_radius=0.15, crown_radius=6.0 * CROWN_SHARE[1])


def spec_of(*trees: Tree, seed: int = 0) -> mujoco.MjSpec:
    spec = mujoco.MjSpec()
    add_materials(spec)
    add_trees(spec, trees, rng=np.random.default_rng(seed))
    return spec


def crowns(spec: mujoco.MjSpec) -> np.ndarray:
    """Corners of all triangles of crowns, shape (N, 3, 3) [m]."""
    corners = [
        np.array(mesh.uservert).reshape(-1, 3)[np.array(mesh.userface).reshape(-1, 3)]
        for mesh in spec.meshes
    ]
    return np.concatenate(corners)


def test_crown_is_closed_looks_outwards_and_is_about_an_egg():
    first, second, third = np.moveaxis(crowns(spec_of(TREE)), 1, 0)
    volume = np.sum(first * np.cross(second, third)) / 6.0
    egg = 4.0 / 3.0 * np.pi * TREE.crown_radius**3
    assert 0.4 * egg < volume < 1.3 * egg


def test_trunk_reaches_into_the_crown_and_cars_pass_below_it():
    spec = spec_of(TREE)
    trunk = spec.compile().geom("tree_0")
    heights = crowns(spec)[..., 2]
    assert trunk.contype[0]
    assert trunk.pos[:2] == pytest.approx([TREE.x, TREE.y])
    assert 1.6 < heights.min() < trunk.pos[2] + trunk.size[1] < heights.max()
    assert heights.max() == pytest.approx(TREE.height, abs=0.01)


def test_crowns_are_fused_by_colour_and_differ_from_tree_to_tree():
    row = [Tree(10.0 * number, 0.0, 6.0, 0.15, 1.5) for number in range(20)]
    spec = spec_of(*row)
    assert len(spec.meshes) == 2
    shapes = {
        (corners[0] - corners[1]).round(2).tobytes()
        for corners in crowns(spec).reshape(20, -1, 3, 3)[:, 0]
    }
    assert len(shapes) > 10


def test_same_seed_grows_the_same_crowns():
    assert np.array_equal(crowns(spec_of(TREE, seed=4)), crowns(spec_of(TREE, seed=4)))
    assert not np.array_equal(crowns(spec_of(TREE, seed=4)), crowns(spec_of(TREE, seed=5)))
