"""Trees in verges and gardens, from a seed."""

from dataclasses import dataclass

import numpy as np
import shapely

from mjdrive.town.scenery.blocks import rings
from mjdrive.town.scenery.neighbourhood import Box, Neighbourhood
from mjdrive.town.settings import SceneryConfig

TRUNK_RADIUS = (0.11, 0.19)  # [m]
CROWN_SHARE = (0.20, 0.27)  # radius of the crown as a share of the height [-]
SPACING_SPREAD = 0.3  # the distance between two trees varies by this share [-]
STRAIGHTENING = 0.05  # of the line on which trees stand [m]


@dataclass(frozen=True, slots=True)
class Tree:
    """A tree beside the road.

    Attributes:
        x: Middle of the trunk, world frame [m].
        y: Middle of the trunk, world frame [m].
        height: To the top [m].
        trunk_radius: At the ground [m].
        crown_radius: Of the foliage [m].
    """

    x: float
    y: float
    height: float
    trunk_radius: float
    crown_radius: float


def plant_trees(
    verge: shapely.Geometry,
    scenery: SceneryConfig,
    rng: np.random.Generator,
    *,
    middle: shapely.Geometry,
    keep_clear: shapely.Geometry,
) -> tuple[Tree, ...]:
    """Plant trees along the middle of the verges.

    Args:
        verge: Grass beside the road [m].
        scenery: Spacing and sizes; a spacing of 0 plants none.
        rng: Draws places and sizes.
        middle: Area whose outline runs along the middle of the verges [m].
        keep_clear: Where drivers have to see, or where other things stand [m].

    Returns:
        Trees whose trunks stand wholly on the verge, outside the ground to keep clear.
    """
    if not scenery.tree_spacing:
        return ()
    trees = []
    shapely.prepare(keep_clear)
    for ring in rings(shapely.simplify(middle, STRAIGHTENING)):
        line = shapely.LineString(ring)
        station = scenery.tree_spacing * rng.uniform()
        while station < line.length:
            tree = _tree(line.interpolate(station), scenery, rng)
            spot = shapely.Point(tree.x, tree.y)
            if not keep_clear.intersects(spot) and verge.contains(spot.buffer(tree.trunk_radius)):
                trees.append(tree)
            station += scenery.tree_spacing * (1.0 + SPACING_SPREAD * rng.uniform(-1.0, 1.0))
    return tuple(trees)


def plant_gardens(
    gardens: shapely.Geometry, scenery: SceneryConfig, rng: np.random.Generator
) -> tuple[Tree, ...]:
    """Scatter trees over gardens and parks.

    Args:
        gardens: Where trunks may stand [m].
        scenery: Spacing and sizes; a spacing of 0 plants none.
        rng: Draws places and sizes.

    Returns:
        Trees with room between them; as many as fit.
    """
    trees: list[Tree] = []
    if not scenery.garden_tree_spacing or gardens.is_empty:
        return ()
    shapely.prepare(gardens)
    left, bottom, right, top = gardens.bounds
    num_tries = round((right - left) * (top - bottom) / scenery.garden_tree_spacing**2)
    planted = Neighbourhood[Tree](cell=2.0 * max(1.0, CROWN_SHARE[1] * scenery.tree_height[1]))
    for _ in range(num_tries):  # those that fall outside keep the density of those inside
        spot = shapely.Point(rng.uniform(left, right), rng.uniform(bottom, top))
        tree = _tree(spot, scenery, rng)
        if gardens.contains(spot) and not any(
            _touch(tree, other) for other in planted.near(_crown(tree))
        ):
            trees.append(tree)
            planted.add(tree, _crown(tree))
    return tuple(trees)


def _crown(tree: Tree) -> Box:
    """Ground under a crown [m]."""
    radius = tree.crown_radius
    return tree.x - radius, tree.y - radius, tree.x + radius, tree.y + radius


def _touch(one: Tree, other: Tree) -> bool:
    gap = np.hypot(one.x - other.x, one.y - other.y)
    return bool(gap <= one.crown_radius + other.crown_radius)


def _tree(spot: shapely.Point, scenery: SceneryConfig, rng: np.random.Generator) -> Tree:
    height = rng.uniform(*scenery.tree_height)
    return Tree(
        x=spot.x,
        y=spot.y,
        height=height,
        trunk_radius=rng.uniform(*TRUNK_RADIUS),
        crown_radius=height * rng.uniform(*CROWN_SHARE),
    )
