"""Tables about towns."""

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import groupby

from rich.console import Console
from rich.table import Table
from rich.text import Text

from mjdrive.datatypes import Move, Town
from mjdrive.town import library
from mjdrive.town.check import Finding, Severity
from mjdrive.town.lane_graph import lane_length
from mjdrive.town.opendrive.read_report import ReadReport

MOST_FINDINGS = 5
"""Of each kind and severity; after that the table says how many more there are."""

_STYLES = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.NOTE: "default"}


def towns_table(towns: Mapping[str, Town]) -> None:
    """Print one line a town."""
    table = Table(box=None, header_style="bold")
    for heading in ("town", "lanes", "junctions", "lights", "routes", "what it is"):
        table.add_column(heading, justify="left" if heading in ("town", "what it is") else "right")
    for name, town in towns.items():
        settings = library.load_settings(name)
        table.add_row(
            name,
            f"{_length(town) / 1000:.1f} km",
            str(len(junctions_of(town))),
            str(len(town.lights)),
            str(len(settings.routes)),
            Text(settings.description),
        )
    Console().print(table)


def figures_of(town: Town) -> dict[str, str]:
    """Name what there is in a town, for a table of two columns."""
    moves = Counter(lane.move for lane in town.lanes.values() if lane.junction is not None)
    west, south, east, north = town.bounds
    return {
        "lanes": f"{len(town.lanes)}, {_length(town):,.0f} m",
        "extent": f"{east - west:,.0f} m x {north - south:,.0f} m",
        "junctions": str(len(junctions_of(town))),
        "ways through them": ", ".join(
            f"{moves[move]} {move.name.lower()}" for move in (Move.LEFT, Move.STRAIGHT, Move.RIGHT)
        ),
        "lights": str(len(town.lights)),
        "signs, other things": f"{len(town.signs)}, {len(town.objects)}",
        "routes for collect": str(len(library.load_settings(town.name).routes)),
        "digest": town.digest[:16],
    }


def junctions_of(town: Town) -> set[str]:
    """Names of the junctions of a town."""
    return {lane.junction for lane in town.lanes.values() if lane.junction is not None}


def _length(town: Town) -> float:
    return sum(lane_length(lane) for lane in town.lanes.values())


def report_table(report: ReadReport) -> None:
    """Print what was read from a map, and all that was not used."""
    table = Table(
        title=Text(f"{report.source}: OpenDRIVE {report.version}"),
        title_justify="left",
        show_header=False,
    )
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    table.add_row("roads", f"{report.roads}, {report.length:,.0f} m")
    table.add_row("junctions", str(report.junctions))
    for heading, counts in (
        ("lanes", report.lanes),
        ("signals", report.signals),
        ("objects", report.objects),
        ("not used", report.not_used),
    ):
        text = ", ".join(f"{count} {kind}" for kind, count in counts.items())
        table.add_row(heading, Text(text or "none"))
    if report.flattened.roads:
        flattened = report.flattened
        table.add_row(
            "flattened",
            f"{flattened.roads} roads, {flattened.height:.2f} m between highest and lowest, steepest slope "
            f"{100 * flattened.slope:.1f} %",
        )
    Console().print(table)


def findings_table(name: str, findings: Sequence[Finding]) -> None:
    """Print what a check found, a few of each kind."""
    console = Console()
    if not findings:
        console.print(Text(f"✓ {name}: nothing found that would break a drive.", style="green"))
        return
    table = Table(title=Text(f"{name}, checked"), title_justify="left", header_style="bold")
    table.add_column("severity")
    table.add_column("what")
    table.add_column("where", overflow="fold")
    table.add_column("why", overflow="fold")
    for (severity, kind), group in groupby(findings, key=lambda f: (f.severity, f.kind)):
        same = list(group)
        for finding in same[:MOST_FINDINGS]:
            where, why = Text(finding.where), Text(finding.text)
            table.add_row(severity.name.lower(), kind, where, why, style=_STYLES[severity])
        if len(same) > MOST_FINDINGS:
            table.add_row(severity.name.lower(), kind, "", f"and {len(same) - MOST_FINDINGS} more")
    console.print(table)
