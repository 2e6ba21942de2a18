"""Walk every lane of a town and say what would break a drive, or make it a poor one."""

from collections.abc import Iterator

import numpy as np

from mjdrive.datatypes import Lane, Town
from mjdrive.geometry import headings, wrap_angle
from mjdrive.town.bends import tight_turns
from mjdrive.town.findings import Finding, FindingKind, Severity
from mjdrive.town.lane_graph import lane_length, onward, round_trips
from mjdrive.town.light_findings import light_findings
from mjdrive.town.obstructions import obstructions
from mjdrive.town.opendrive.road_map import RoadMap

__all__ = ["Finding", "FindingKind", "Severity", "check"]

LARGEST_GAP = 0.01
"""Largest distance between the end of a lane and the start of its successor [m]."""

LARGEST_KINK = 0.1
"""Largest change of direction from a lane to its successor; half a chord of a tight bend takes 0.06 of it [rad]."""

NARROWEST_LANE = 1.8
"""Narrowest lane that the car fits into [m]."""

SHORTEST_LANE = 0.001
"""Shortest lane that cars have a direction on [m]."""

TIGHTEST_TURN = 3.5
"""Smallest radius that the car can follow at the centre of the lane without cutting the bend [m]."""


def check(town: Town, road_map: RoadMap | None = None) -> tuple[Finding, ...]:
    """Look for what would break a drive.

    Args:
        town: The town.
        road_map: The map that it was built from; without it, lights that control nothing are not found.

    Returns:
        What was found, the worst first, in the order of kinds and lanes.
    """
    found = [finding for lane in town.lanes.values() for finding in _lane_findings(town, lane)]
    found += _tight_turns(town)
    found += _unreached(town)
    found += _on_lanes(town)
    found += _islands(town)
    found += _short_drives(town)
    found += light_findings(town, road_map)
    kinds = list(FindingKind)
    return tuple(sorted(found, key=lambda f: (-f.severity, kinds.index(f.kind))))


def _lane_findings(town: Town, lane: Lane) -> Iterator[Finding]:
    yield from _joints(town, lane)
    length = lane_length(lane)
    if length < SHORTEST_LANE:
        yield Finding(
            FindingKind.NO_LENGTH,
            Severity.ERROR,
            lane.id,
            f"The lane is {length:.4f} m long; expected {SHORTEST_LANE} m or more. Its middle may lie at the centre of a bend.",
        )
    if not lane.successors:
        yield _dead_end(town, lane)
    widths = np.array([lane.width]) if lane.widths is None else lane.widths
    if widths.min() < NARROWEST_LANE:
        always = bool(widths.max() < NARROWEST_LANE)
        yield Finding(
            FindingKind.NARROW,
            Severity.WARNING if always else Severity.NOTE,
            lane.id,
            f"The lane is {widths.max() if always else widths.min():.2f} m wide {'at most' if always else 'where it tapers'}; the car "
            f"needs {NARROWEST_LANE} m.",
        )


def _dead_end(town: Town, lane: Lane) -> Finding:
    if any(town.lanes[name].successors for name in _beside(town, lane)):
        text = (
            "The lane ends and others beside it go on; routes, which never change lanes, avoid it."
        )
        return Finding(FindingKind.DEAD_END, Severity.WARNING, lane.id, text)
    return Finding(FindingKind.DEAD_END, Severity.ERROR, lane.id, "The lane leads to no other.")


def _beside(town: Town, lane: Lane) -> Iterator[str]:
    """Name all lanes beside a lane in the same direction."""
    for side in ("left", "right"):
        name = getattr(lane, side)
        while name is not None:
            yield name
            name = getattr(town.lanes[name], side)


def _joints(town: Town, lane: Lane) -> Iterator[Finding]:
    """Compare the end of a lane with the starts of those that follow."""
    for name in lane.successors:
        following = town.lanes[name].centerline
        gap = float(np.hypot(*(following[0] - lane.centerline[-1])))
        if gap > LARGEST_GAP:
            yield Finding(
                FindingKind.GAP,
                Severity.ERROR,
                lane.id,
                f"The lane ends {gap:.3f} m from the start of its successor '{name}'; expected {LARGEST_GAP} m or less.",
            )
        turn = abs(wrap_angle(float(headings(following)[0] - headings(lane.centerline)[-1])))
        if turn > LARGEST_KINK:
            yield Finding(
                FindingKind.KINK,
                Severity.WARNING,
                lane.id,
                f"Its successor '{name}' sets off {np.rad2deg(turn):.0f} degrees to the side.",
            )


def _tight_turns(town: Town) -> list[Finding]:
    return [
        Finding(
            FindingKind.TIGHT_TURN,
            Severity.NOTE,
            lane.id,
            f"Its centre bends with a radius of {radius:.1f} m; the car follows {TIGHTEST_TURN} m and cuts this bend.",
        )
        for lane, radius in tight_turns(town, TIGHTEST_TURN)
    ]


def _unreached(town: Town) -> list[Finding]:
    reached = {name for lane in town.lanes.values() for name in lane.successors}
    return [
        Finding(
            FindingKind.UNREACHED,
            Severity.NOTE
            if any(beside in reached for beside in _beside(town, lane))
            else Severity.WARNING,
            name,
            "No lane leads to it: cars can only start there.",
        )
        for name, lane in town.lanes.items()
        if name not in reached
    ]


def _on_lanes(town: Town) -> list[Finding]:
    return [
        Finding(
            FindingKind.ON_LANE,
            Severity.ERROR,
            thing.thing,
            f"The {thing.what or 'object'} stands at ({thing.x:.1f}, {thing.y:.1f}) on lane "
            + ", ".join(f"'{name}'" for name in thing.lanes[:3])
            + (f" and {len(thing.lanes) - 3} more" if len(thing.lanes) > 3 else "")
            + ": cars run into it. Check its s and t.",
        )
        for thing in obstructions(town)
    ]


def _islands(town: Town) -> list[Finding]:
    """Find parts of the town that one can drive around in, but not to and fro between."""
    parts = sorted(
        round_trips(town),
        key=lambda part: -sum(lane_length(town.lanes[name]) for name in part),
    )
    return [
        Finding(
            FindingKind.ISLAND,
            Severity.WARNING,
            part[0],
            f"{len(part)} lanes, {sum(lane_length(town.lanes[name]) for name in part):.0f} m, hang together with this "
            "one, but no way leads there and back from the largest part of the town.",
        )
        for part in parts[1:]
    ]


def _short_drives(town: Town) -> list[Finding]:
    """Tell where every drive comes to an end."""
    if round_trips(town):
        return []
    ahead = onward(town)
    longest = max(lane_length(lane) + ahead[name] for name, lane in town.lanes.items())
    text = (
        f"No lane lies on a round trip: every drive comes to an end, after {longest:.0f} m at most. Routes for "
        "demonstrations are short, or none."
    )
    return [Finding(FindingKind.SHORT_DRIVES, Severity.WARNING, town.name, text)]
