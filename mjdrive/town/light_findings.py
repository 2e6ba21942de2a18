"""What can be wrong with the traffic lights of a town."""

import numpy as np
import shapely

from mjdrive.datatypes import Town
from mjdrive.town import signals
from mjdrive.town.findings import Finding, FindingKind, Severity
from mjdrive.town.lights import light_signals
from mjdrive.town.opendrive.road_map import RoadMap

_SHARED_END = 0.1
"""Stop lines of lanes side by side meet; what they share at their ends is no crossing [m]."""


def light_findings(town: Town, road_map: RoadMap | None) -> list[Finding]:
    """Look for lights that break a drive.

    Args:
        town: The town.
        road_map: The map that it was built from; without it, lights that control nothing are not found.

    Returns:
        What was found.
    """
    found = _never_green(town) + _crossed_stop_lines(town)
    return found if road_map is None else found + _idle_lights(town, road_map)


def _never_green(town: Town) -> list[Finding]:
    return [
        Finding(
            FindingKind.NEVER_GREEN,
            Severity.ERROR,
            light.id,
            f"It shows {signals.in_words(light)}: nobody ever passes the end of lane '{light.lane}'. See 'lights' in town.json.",
        )
        for light in town.lights.values()
        if not signals.turns_green(light)
    ]


def _crossed_stop_lines(town: Town) -> list[Finding]:
    lights = list(town.lights.values())
    lines = [_without_ends(light.stop_line) for light in lights]
    found = []
    for first, second in _pairs(lines):
        if lights[first].lane != lights[second].lane:
            found.append(
                Finding(
                    FindingKind.CROSSED_STOP_LINES,
                    Severity.ERROR,
                    lights[first].id,
                    f"Its stop line crosses that of light '{lights[second].id}': whoever passes one passes both.",
                )
            )
    return found


def _pairs(lines: list[shapely.LineString]) -> list[tuple[int, int]]:
    geometries = np.array(lines, dtype=object)
    first, second = shapely.STRtree(geometries).query(geometries, predicate="intersects")
    return [(int(a), int(b)) for a, b in zip(first, second, strict=True) if a < b]


def _without_ends(line: np.ndarray) -> shapely.LineString:
    along = line[1] - line[0]
    share = min(0.45, _SHARED_END / max(float(np.hypot(*along)), 1e-9))
    return shapely.LineString([line[0] + share * along, line[1] - share * along])


def _idle_lights(town: Town, road_map: RoadMap) -> list[Finding]:
    busy = {light.signal or light.id for light in town.lights.values()}
    return [
        Finding(
            FindingKind.IDLE_LIGHT,
            Severity.ERROR,
            signal,
            f"The light beside road '{road.id}' stops no lane into a junction. Check its <validity> and its place.",
        )
        for signal, (road, _) in light_signals(road_map).items()
        if signal not in busy
    ]
