"""Paint on the road: lane lines, stop lines, crosswalks and parking spaces."""

from collections.abc import Iterator, Sequence
from functools import lru_cache

import mujoco
import numpy as np
import shapely
from jaxtyping import Float

from mjdrive.datatypes import Marking, Town
from mjdrive.geometry import offset_polyline, stations
from mjdrive.simulation import palette
from mjdrive.simulation.meshes import Shell
from mjdrive.town import surface
from mjdrive.town.scenery import ground_of

PAINT_HEIGHT = (
    0.01  # [m]; enough to be drawn above the asphalt, and invisible from where cameras are
)
BETWEEN_COLORS = 0.001  # [m]
ABOVE_LINES = PAINT_HEIGHT + 0.006  # height of stop lines and crosswalks [m]
NARROWEST_LINE = 0.12  # thinner paint is drawn this wide, to be seen [m]
SMOOTHING = 0.005  # lines keep corners larger than this [m]
CENTRE_LINE = Marking(points=np.zeros((2, 2)), width=0.15, color="white", dash=3.0, gap=3.0)
STOP_LINE_THICKNESS = 0.4  # along the lane [m]
STOP_LINE_INSET = 0.2  # at both ends [m]
FROM_KERB = 1.0  # edges of lanes nearer to it are no lines between lanes [m]
SAME_LINE = 0.5  # edges of lanes closer than this are one line [m]
ZEBRA_STRIPE = 0.5  # width of a stripe, and of the gap beside it [m]
OUTLINE_WIDTH = 0.12  # of parking spaces [m]


def add_markings(spec: mujoco.MjSpec, town: Town) -> None:
    """Paint the road of a town; maps without road marks get broken lines between their lanes.

    Args:
        spec: Scene with the materials of `palette`.
        town: Road network.
    """
    ribbons: dict[str, list[shapely.Geometry]] = {}
    for marking in town.markings or centre_lines(town):
        half = 0.5 * max(marking.width, NARROWEST_LINE)
        lines = [shapely.LineString(piece) for piece in painted(marking)]
        paint = shapely.buffer(lines, half, cap_style="flat", join_style="mitre")
        ribbons.setdefault(marking.color, []).extend(paint)
    for layer, (color, paint) in enumerate(sorted(ribbons.items())):
        height = PAINT_HEIGHT + layer * BETWEEN_COLORS
        _show(spec, f"marking_{color}", paint, material=palette.paint(spec, color), height=height)
    bars = [shapely.Polygon(bar) for bar in stop_bars(town)]
    _show(spec, "stop_bars", bars, material="white_paint", height=ABOVE_LINES)
    areas = []
    for thing in town.objects:
        outline = ground_of([thing.outline])
        if outline.is_empty:
            continue
        if thing.type == "crosswalk":
            areas.append(zebra(outline, town))
        elif thing.type == "parkingSpace":
            areas.append(outline - shapely.buffer(outline, -OUTLINE_WIDTH))
    _show(spec, "crosswalks", areas, material="white_paint", height=ABOVE_LINES)


def _show(
    spec: mujoco.MjSpec,
    name: str,
    paint: Sequence[shapely.Geometry],
    *,
    material: str,
    height: float,
) -> None:
    """Show paint joined: where a map paints twice, the sun would shine twice."""
    shell = Shell()
    shell.area(shapely.union_all(paint), height=height)
    shell.show(spec, name, material=material)


def centre_lines(town: Town) -> list[Marking]:
    """Broken lines where two lanes lie side by side outside junctions, for maps that paint nothing.

    Args:
        town: Road network.

    Returns:
        One line between each two lanes.
    """
    kerb = shapely.boundary(surface.road_surface(town))
    shapely.prepare(kerb)
    edges = [
        offset_polyline(lane.centerline, side * lane.width)
        for lane in town.lanes.values()
        for side in ((0.5, -0.5) if lane.junction is None else ())
    ]
    lines = [shapely.LineString(edge) for edge in edges]
    middles = shapely.line_interpolate_point(lines, 0.5, normalized=True)
    inside = ~shapely.dwithin(kerb, middles, FROM_KERB)
    tree = shapely.STRtree(lines)
    drawn: set[int] = set()
    for number in np.flatnonzero(inside).tolist():
        same = tree.query(middles[number], predicate="dwithin", distance=SAME_LINE)
        if drawn.isdisjoint(same.tolist()):
            drawn.add(number)
    look = (CENTRE_LINE.width, CENTRE_LINE.color, CENTRE_LINE.dash, CENTRE_LINE.gap)
    return [Marking(edges[number], *look) for number in sorted(drawn)]


def painted(marking: Marking) -> Iterator[Float[np.ndarray, "_ 2"]]:
    """Cut a marking into its dashes; an unbroken line is one piece.

    Args:
        marking: The line.

    Yields:
        Middle of each piece of paint, world frame [m].
    """
    station = stations(marking.points)
    end = float(station[-1])
    step = marking.dash + marking.gap if marking.dash > 0.0 else end
    length = marking.dash if marking.dash > 0.0 else end
    start = 0.0
    while step > 0.0 and start < end - SMOOTHING:
        stop = min(start + length, end)
        inner = station[(station > start) & (station < stop)]
        along = np.concatenate([[start], inner, [stop]])
        points = np.stack(
            [np.interp(along, station, marking.points[:, axis]) for axis in (0, 1)], axis=1
        )
        yield shapely.get_coordinates(shapely.simplify(shapely.LineString(points), SMOOTHING))
        start += step


def stop_bars(town: Town) -> list[Float[np.ndarray, "4 2"]]:
    """Bars across the approaches, their far edge on the stop line.

    Args:
        town: Road network.

    Returns:
        Corners of each bar, counter-clockwise, world frame [m].
    """
    bars = []
    for light in town.lights.values():
        left, right = light.stop_line
        across = (right - left) / np.hypot(*(right - left))
        back = -np.array([np.cos(light.yaw), np.sin(light.yaw)])
        middle = 0.5 * STOP_LINE_THICKNESS * back
        inset = STOP_LINE_INSET * across
        ends = left + inset + middle, right - inset + middle
        side = 0.5 * STOP_LINE_THICKNESS * np.array([-across[1], across[0]])
        bars.append(np.array([ends[0] - side, ends[1] - side, ends[1] + side, ends[0] + side]))
    return bars


def zebra(area: shapely.Geometry, town: Town) -> shapely.Geometry:
    """Stripe a crosswalk along the traffic that it crosses.

    Args:
        area: The crosswalk, not empty [m].
        town: Road network; its nearest lane says which way the stripes run.

    Returns:
        The stripes, world frame [m].
    """
    middle = shapely.get_coordinates(area.centroid)[0]
    tree = _centre_lines(town)
    line = tree.geometries[min(tree.query_nearest(area.centroid))]
    station = line.project(area.centroid)
    before, after = (
        shapely.get_coordinates(line.interpolate(max(station + step, 0.0)))[0]
        for step in (-0.5, 0.5)
    )
    along = (after - before) / np.hypot(*(after - before))
    across = np.array([-along[1], along[0]])
    reach = float(np.hypot(*(shapely.get_coordinates(area) - middle).T).max())
    stripes = [
        _ribbon(
            np.array([middle - reach * along, middle + reach * along]) + offset * across,
            ZEBRA_STRIPE,
        )
        for offset in np.arange(-reach, reach, 2.0 * ZEBRA_STRIPE)
    ]
    return shapely.intersection(shapely.union_all(shapely.polygons(stripes)), area)


@lru_cache(maxsize=4)
def _centre_lines(town: Town) -> shapely.STRtree:
    return shapely.STRtree([shapely.LineString(lane.centerline) for lane in town.lanes.values()])


def _ribbon(points: Float[np.ndarray, "2 2"], width: float) -> Float[np.ndarray, "4 2"]:
    return np.concatenate(
        [offset_polyline(points, -0.5 * width), offset_polyline(points, 0.5 * width)[::-1]]
    )
