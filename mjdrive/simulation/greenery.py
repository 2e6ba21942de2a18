"""Trees: trunks that the car can hit, and crowns for the eye."""

from collections.abc import Sequence

import mujoco
import numpy as np

from mjdrive.simulation.blocks import add_post
from mjdrive.simulation.meshes import Shell
from mjdrive.town.scenery.street_trees import Tree

CROWN_RINGS = (
    (-0.62, 0.66),
    (-0.05, 1.0),
    (0.58, 0.72),
)  # height and radius over those of the crown [-]
CROWN_SIDES = 6
ROUGHNESS = 0.14  # spread of the radius [-]
CROWN_STRETCH = 1.25  # half height over radius [-]


def add_trees(
    spec: mujoco.MjSpec, trees: Sequence[Tree], *, rng: np.random.Generator, prefix: str = "tree"
) -> None:
    """Stand trees.

    Args:
        spec: Scene with the materials of `palette`.
        trees: Where they stand and how large they are.
        rng: Draws how their crowns grow.
        prefix: Of the names of their trunks.
    """
    crowns = {"leaves": Shell(decimals=2), "young_leaves": Shell(decimals=2)}
    for number, tree in enumerate(trees):
        half = CROWN_STRETCH * tree.crown_radius
        add_post(
            spec,
            f"{prefix}_{number}",
            x=tree.x,
            y=tree.y,
            radius=tree.trunk_radius,
            height=tree.height - 1.4 * half,
            material="trunk",
        )
        _grow(crowns["leaves" if rng.uniform() < 0.6 else "young_leaves"], tree, half, rng)
    for material, shell in crowns.items():
        shell.show(spec, f"crowns_of_{prefix}_{material}", material=material)


def _grow(shell: Shell, tree: Tree, half: float, rng: np.random.Generator) -> None:
    """A rough egg out of rings of vertices between a lowest and a highest one."""
    centre = np.array([tree.x, tree.y, tree.height - half])
    vertices = [np.array([[0.0, 0.0, -half]])]
    turn = rng.uniform(0.0, 2.0 * np.pi)
    for number, (level, share) in enumerate(CROWN_RINGS):
        angle = turn + (np.arange(CROWN_SIDES) + 0.5 * number) * 2.0 * np.pi / CROWN_SIDES
        spread = 1.0 + ROUGHNESS * rng.uniform(-1.0, 1.0, CROWN_SIDES)
        radius = tree.crown_radius * share * spread
        height = half * (level + ROUGHNESS * rng.uniform(-1.0, 1.0, CROWN_SIDES))
        vertices.append(np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height]))
    vertices.append(np.array([[0.0, 0.0, half]]))
    shell.add(np.concatenate(vertices) + centre, _egg_faces())


def _egg_faces() -> np.ndarray:
    here = np.arange(CROWN_SIDES)
    beside = (here + 1) % CROWN_SIDES
    top = 1 + len(CROWN_RINGS) * CROWN_SIDES
    faces = [np.stack([0 * here, 1 + beside, 1 + here], axis=1)]
    for ring in range(len(CROWN_RINGS) - 1):
        low, high = 1 + ring * CROWN_SIDES, 1 + (ring + 1) * CROWN_SIDES
        faces.append(np.stack([low + here, low + beside, high + here], axis=1))
        faces.append(np.stack([low + beside, high + beside, high + here], axis=1))
    last = top - CROWN_SIDES
    faces.append(np.stack([last + here, last + beside, 0 * here + top], axis=1))
    return np.concatenate(faces)
