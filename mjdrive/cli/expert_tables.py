"""What drives of experts were like, as tables in Markdown: for the terminal and for docs/experts.md."""

import statistics
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from mjdrive.cli.solving import solve_rows
from mjdrive.evaluation.expert_bars import ExpertBar, mean_cpu_ms, mean_ms, rms, slow_share
from mjdrive.evaluation.expert_drives import Checks, Drive
from mjdrive.evaluation.steering_bound import Bound

NUM_SEEDS = 10
"""Light seeds under which an expert should be checked [-]."""


def provenance(checks: Checks) -> str:
    """What was driven, where and with what, in a sentence."""
    drives, machine = checks.drives, checks.machine
    versions = machine["versions"]
    packages = ", ".join(f"{name} {versions[name]}" for name in ("mjdrive", "mujoco", "casadi"))
    seeds = ", ".join(
        f"{sum(it.expert == expert for it in drives)} by the {expert.upper()} "
        f"(light seeds {_seeds(it for it in drives if it.expert == expert)})"
        for expert in dict.fromkeys(it.expert for it in drives)
    )
    return (
        f"{len(drives)} drives: {seeds}. Driven on {machine['num_cores']} cores of {machine['processor']} at a load of "
        f"{machine['load']:g}, with {packages} and code {checks.code[:12]}.{_to_come(drives)}"
    )


def _to_come(drives: Sequence[Drive]) -> str:
    """Say it if not all light seeds were driven yet."""
    counts = Counter((it.expert, it.town, it.route) for it in drives)
    fewest = min(counts.values(), default=0)
    if fewest >= NUM_SEEDS:
        return ""
    return f" **{NUM_SEEDS} light seeds are asked for: no route has fewer than {fewest} so far.**"


def _seeds(drives: Iterable[Drive]) -> str:
    """Light seeds, and which of them not all routes were driven under."""
    counts = Counter(it.seed for it in drives)
    most = max(counts.values())
    whole = ", ".join(str(seed) for seed in sorted(counts) if counts[seed] == most)
    part = "".join(
        f"; seed {seed} on {counts[seed]} of {most} routes"
        for seed in sorted(counts)
        if counts[seed] < most
    )
    return whole + part


def laps_table(drives: Sequence[Drive]) -> str:
    """Whether drives were flawless, a line an expert and town; the routes of a town are one lap under each seed."""
    rows = [
        (
            expert,
            town,
            f"{sum(not it.flaw for it in group)} of {len(group)}",
            sum(len(it.infractions) for it in group),
            f"{sum(it.off_road_s for it in group):.1f} s",
            sum(len(it.rash_lights) for it in group),
            f"{max(it.slowest_start_s for it in group):.1f} s",
            _laps(group),
        )
        for expert, town, group in _groups(drives)
    ]
    return markdown(
        (
            "expert",
            "town",
            "flawless drives",
            "infractions",
            "off road",
            "yellows passed that left room",
            "slowest start after green",
            "all routes, mean and s.d. over the light seeds",
        ),
        rows,
    )


def times_table(drives: Sequence[Drive]) -> str:
    """How long experts took to decide, standing at lights included, a line an expert and town."""
    rows = []
    for expert, town, arrived in _groups([it for it in drives if it.steps]):
        rows.append(
            (
                expert,
                town,
                f"{sum(it.steps for it in arrived):,}",
                f"{mean_ms(arrived):.2f} ms",
                f"{statistics.median(it.wall.p99_ms for it in arrived):.1f} ms",
                f"{max(it.wall.max_ms for it in arrived):.0f} ms",
                f"{100 * slow_share(arrived):.3f} %",
                f"{mean_cpu_ms(arrived):.2f} ms",
                f"{max(it.cpu.p99_ms for it in arrived):.1f} ms",
                f"{max(it.cpu.max_ms for it in arrived):.1f} ms",
                "; ".join(
                    solve_rows(
                        (it.solver for it in arrived), (it.solves for it in arrived)
                    ).values()
                )
                or "-",
            )
        )
    return markdown(
        (
            "expert",
            "town",
            "decisions",
            "mean",
            "p99 of a drive, median",
            "longest",
            "over 50 ms",
            "CPU time: mean",
            "p99 of the worst drive",
            "longest",
            "solves",
        ),
        rows,
    )


def comfort_table(drives: Sequence[Drive]) -> str:
    """Lane error and smoothness, a line an expert and town, over all of its routes and seeds."""
    rows = []
    for expert, town, arrived in _groups([it for it in drives if it.steps]):
        rows.append(
            (
                expert,
                town,
                f"{rms(arrived, lambda it: it.street_offset_rms_m):.3f} m",
                f"{rms(arrived, lambda it: it.offset_rms_m):.3f} m",
                f"{max(it.offset_rms_m for it in arrived):.3f} m",
                f"{max(it.offset_max_m for it in arrived):.2f} m",
                f"{rms(arrived, lambda it: it.jerk_rms):.2f} m/s³",
                f"{rms(arrived, lambda it: it.steering_unrest):.3f} 1/s²",
                f"{rms(arrived, lambda it: it.steering_whiteness):.3f} 1/s",
            )
        )
    return markdown(
        (
            "expert",
            "town",
            "lane error outside junctions, RMS",
            "whole route, RMS",
            "worst drive, RMS",
            "largest",
            "jerk, RMS",
            "steering unrest",
            "steering whiteness",
        ),
        rows,
    )


def bars_table(bars: Iterable[ExpertBar]) -> str:
    """Each bar of the MPC and what was measured."""
    rows = [
        (
            it.town,
            it.figure,
            f"{it.measured:.3g} {it.unit}".strip(),
            f"{it.most:g} {it.unit}".strip(),
            "yes" if it.holds else "**no**",
        )
        for it in bars
    ]
    return markdown(("MPC in", "figure", "measured", "at most", "held"), rows)


def bounds_table(bounds: Sequence[Bound]) -> str:
    """How smoothly the PID steers, and how smoothly its routes can be steered, a line a route."""
    cases = bounds[0].least[1::2]
    headings = ["route", "PID [1/s]", "half of it", "least at its lane error"]
    headings += [f"least at {it.allowance:g} m, pace {it.pace:g}" for it in cases]
    headings += [f"time at pace {it.pace:g} [s]" for it in cases]
    rows = [
        [
            bound.route,
            f"{bound.whiteness:.3f} ({bound.lane_error:.2f} m)",
            f"{0.5 * bound.whiteness:.3f}",
            f"{bound.least[0].whiteness:.3f}",
            *(f"{it.whiteness:.3f}" for it in bound.least[1::2]),
            *(f"{it.duration:.0f}" for it in bound.least[1::2]),
        ]
        for bound in bounds
    ]
    return markdown(headings, rows)


def markdown(headings: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table in Markdown."""
    lines = [headings, ["---"] * len(headings), *rows]
    return "\n".join(f"| {' | '.join(str(cell) for cell in line)} |" for line in lines)


def _groups(drives: Sequence[Drive]) -> Iterator[tuple[str, str, list[Drive]]]:
    """The drives of each expert in each town, experts and towns in the order in which they come up."""
    for expert in dict.fromkeys(it.expert for it in drives):
        for town in dict.fromkeys(it.town for it in drives):
            group = [it for it in drives if (it.expert, it.town) == (expert, town)]
            if group:
                yield expert, town, group


def _laps(drives: Sequence[Drive]) -> str:
    """How long all routes took, by the seeds under which all of them were driven."""
    by_seed = {
        seed: [it.steps for it in drives if it.seed == seed] for seed in {it.seed for it in drives}
    }
    whole = max(len(steps) for steps in by_seed.values())
    laps = [0.1 * sum(steps) for steps in by_seed.values() if len(steps) == whole]
    spread = statistics.stdev(laps) if len(laps) > 1 else 0.0
    return f"{statistics.mean(laps):,.0f} ± {spread:.0f} s"
