"""What `mjdrive collect` says of the data set that it made, beside the paper's."""

from collections import Counter
from collections.abc import Sequence

from mjdrive.cli.solving import solve_rows
from mjdrive.config import CollectConfig, PidConfig, from_dict
from mjdrive.datatypes import Episode, Move, Town
from mjdrive.episodes.manifest import Collection, Manifest
from mjdrive.evaluation.branches import branches_taken
from mjdrive.vehicle import cars

PAPER_TOWN = "town01"
PAPER_SAMPLES = 21_287
"""Samples of the paper's ten drives, at 10 Hz."""

PAPER_TURNS = {Move.LEFT: 12, Move.RIGHT: 21, Move.STRAIGHT: 14}
"""Ways through junctions on the paper's ten routes."""

PAPER_ROUTES = 10

LAP, LAP_MARGIN = 2100.0, 170.0
"""Time that the PID should take for these routes, and how far from it is near enough [s]."""


def rows(manifest: Manifest, episodes: Sequence[Episode], town: Town) -> dict[str, str]:
    """Sum up a data set for the closing table.

    Args:
        manifest: Its description.
        episodes: Its drives.
        town: Where they took place.
    """
    samples = sum(entry.steps for entry in manifest.episodes)
    infractions: Counter[str] = Counter()
    for entry in manifest.episodes:
        infractions.update(entry.infractions)
    return {
        "episodes": _episodes(manifest),
        "samples": f"{samples:,} ({samples / 10:,.0f} s at 10 Hz)",
        "turns": _turns(episodes, town),
        "the paper's": _beside_the_paper(manifest, samples),
        "infractions": ", ".join(f"{count} {kind}" for kind, count in sorted(infractions.items()))
        or "0",
        **solve_rows(
            (entry.solver for entry in manifest.episodes),
            (entry.solves for entry in manifest.episodes),
        ),
        "recovered": _recovered(manifest),
    }


def _recovered(manifest: Manifest) -> str:
    """How often the expert found back after a push."""
    if all(it.settings.get("disturbance") is None for it in manifest.collections):
        return "none: nothing was disturbed"
    deviations = sum(entry.deviations for entry in manifest.episodes)
    recovered = sum(entry.recovered for entry in manifest.episodes)
    share = f" ({100 * recovered / deviations:.0f} %)" if deviations else ""
    return f"{recovered} of {deviations} deviations after a push{share}"


def _episodes(manifest: Manifest) -> str:
    count = str(len(manifest.episodes))
    collections = len(manifest.collections)
    return count if collections == 1 else f"{count}, of {collections} collections"


def _turns(episodes: Sequence[Episode], town: Town) -> str:
    """Count the ways through junctions that were driven."""
    moves: Counter[Move] = Counter()
    for episode in episodes:
        for lane, count in branches_taken(episode, town).items():
            moves[town.lanes[lane].move] += count
    return _named(moves)


def _named(moves: Counter[Move] | dict[Move, int]) -> str:
    return ", ".join(f"{moves[move]} {move.name.lower()}" for move in PAPER_TURNS)


def _beside_the_paper(manifest: Manifest, samples: int) -> str:
    """The same figures of the paper, and what of this data set makes it another experiment."""
    theirs = f"{PAPER_SAMPLES:,} samples; {_named(PAPER_TURNS)}"
    differences = _differences(manifest)
    if differences:
        return f"{theirs} (not to be compared: this is {', '.join(differences)})"
    verdict = "within" if abs(samples / 10 - LAP) <= LAP_MARGIN else "not within"
    return (
        f"{theirs} (here {100 * (samples / PAPER_SAMPLES - 1):+.1f} % samples; "
        f"{samples / 10:,.0f} s are {verdict} {LAP:,.0f} ± {LAP_MARGIN:.0f} s)"
    )


def _differences(manifest: Manifest) -> list[str]:
    """What sets a data set apart from the paper's, in words."""
    if manifest.town != PAPER_TOWN:
        return [f"another town, {manifest.town}"]
    if manifest.added:
        return ["a mix of collections"]
    first: Collection = manifest.collections[0]
    settings = from_dict(CollectConfig, first.settings)
    routes = {entry.name.rsplit("-", maxsplit=1)[0] for entry in manifest.episodes}
    whole = len(routes) == len(manifest.episodes) == PAPER_ROUTES
    return [
        words
        for differs, words in (
            (settings.random_walk_km > 0, "a random walk"),
            (not settings.random_walk_km and not whole, "not each of the ten routes once"),
            (settings.disturbance is not None, "disturbed, see --preset paper"),
            (settings.expert != "pid", "another expert"),
            (settings.pid != PidConfig(), "an expert of other settings"),
            (first.car != cars.DEFAULT, "another car"),
        )
        if differs
    ]
