"""Every picture of a study, drawn from its JSON files alone."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from mjdrive.bev import picture as bev_picture
from mjdrive.bev.projector import BevProjector
from mjdrive.datatypes import Town
from mjdrive.study.jobs.landscapes import from_record
from mjdrive.study.pictures import (
    figures_ablation,
    figures_choices,
    figures_fans,
    figures_landscape,
    figures_paths,
    figures_progress,
)
from mjdrive.study.pictures.ablation_rows import COLUMNS, ablation_groups, reference_row
from mjdrive.study.pictures.captions import CAPTIONS, DRAWS
from mjdrive.study.pictures.figure_looks import looks, own_arms
from mjdrive.study.pictures.figures_landscape import Panel
from mjdrive.study.records.reading import StudyFiles
from mjdrive.study.records.results import DrivenPath, LandscapeRecord
from mjdrive.vehicle.parameters import VehicleParameters

PICTURES = "pictures"
"""Folder of the pictures."""

VIEW_SCALE = 3
"""Pixels of a picture for one of the bird's-eye view [-]."""

LANDSCAPES_A_PICTURE = 4
"""Policies below each other in one picture; with more it would not fit a screen [-]."""

SIDE_BY_SIDE = ("bc-beta", "da-ibc")
"""Methods whose long drives the paper compares."""


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture of a study.

    Attributes:
        file: Its place in the folder of the study.
        title: What it is called.
        caption: What it shows.
    """

    file: str
    title: str
    caption: str


def draw_pictures(study: StudyFiles, town: Town, folder: Path) -> tuple[Picture, ...]:
    """Draw what the study has something to draw of.

    Args:
        study: What was found.
        town: Where agents drove.
        folder: Of the study; the pictures go into a folder in it.

    Returns:
        The pictures, in the order in which the report shows them.
    """
    (folder / PICTURES).mkdir(parents=True, exist_ok=True)
    draw = _Drawing(study, town, folder)
    parts = (draw.choices(), draw.paths(), draw.landscapes(), draw.fans(), draw.progress())
    return tuple(picture for part in (*parts, draw.ablation()) for picture in part)


class _Drawing:
    """What all pictures are drawn from and to."""

    def __init__(self, study: StudyFiles, town: Town, folder: Path) -> None:
        self._study, self._town, self._folder = study, town, folder
        self._config = study.record.settings
        self._looks = looks(self._config)

    def choices(self) -> Iterator[Picture]:
        """What is seen of the town in time, and the balance of turns."""
        own = own_arms(self._config)
        found = self._study.results
        shown = [*found.references, *(it for it in found.arms if it.arm in own)]
        figures_choices.draw_recall(shown, self._looks, self._path("recall"))
        yield self._picture("recall")
        shares = figures_choices.turn_shares(shown, self._looks)
        for it in found.data:
            if it.choices.passes:
                shares[f"{it.name}, {it.town}"] = dict(it.choices.turn_shares)
        if shares:
            figures_choices.draw_turns(shares, self._path("turns"))
            yield self._picture("turns")

    def paths(self) -> Iterator[Picture]:
        """Long drives: the paper's two beside each other, then all."""
        paths = self._study.paths
        methods = {it.name: it.method for it in self._config.variants}
        method_of = {it.name: methods[it.variant] for it in self._config.arms}
        pair = [
            next((it for it in paths if method_of.get(it.arm) == method), None)
            for method in SIDE_BY_SIDE
        ]
        both = [it for it in pair if it is not None]
        if len(both) == len(SIDE_BY_SIDE):
            self._draw_paths(both, "trajectories", columns=2)
            yield self._picture("trajectories")
        if len(paths) > len(both):
            self._draw_paths(paths, "all-trajectories", columns=3)
            yield self._picture("all-trajectories")

    def landscapes(self) -> Iterator[Picture]:
        """What agents think at the same moments, a few of them in a picture."""
        records = self._study.landscapes
        draws = DRAWS["dfo" if any(it.drawn_by == "dfo" for it in records) else "own"]
        agents = list(dict.fromkeys((it.arm, it.seed) for it in records))
        for number, first in enumerate(range(0, len(agents), LANDSCAPES_A_PICTURE), start=1):
            shown = agents[first : first + LANDSCAPES_A_PICTURE]
            name = f"landscapes-{number}"
            self._draw_landscapes([it for it in records if (it.arm, it.seed) in shown], name)
            drawn = self._picture(name, "landscapes")
            drawn = replace(drawn, caption=drawn.caption.format(draws=draws))
            several = f"{drawn.title} ({number})"
            yield drawn if len(agents) <= LANDSCAPES_A_PICTURE else replace(drawn, title=several)

    def fans(self) -> Iterator[Picture]:
        """One moment lived many times."""
        fans = [(self._label(it.arm, it.seed), it) for it in self._study.fans if it.paths]
        if fans:
            figures_fans.draw_fans(fans, self._town, self._path("fans"))
            yield self._picture("fans")

    def progress(self) -> Iterator[Picture]:
        """How agents drive while they learn."""
        progress = [it for it in self._study.results.progress if it.drives]
        if progress:
            branches = self._study.results.arms[0].choices.branches
            path = self._path("progress")
            figures_progress.draw_progress(progress, self._looks, branches, path)
            drawn = self._picture("progress")
            note = figures_progress.seeds_in_words(progress, self._looks)
            yield replace(drawn, caption=f"{drawn.caption} {note}".rstrip())

    def ablation(self) -> Iterator[Picture]:
        """What single changes are worth."""
        groups = ablation_groups(self._study, self._looks)
        expert = reference_row(self._study, self._looks)
        figures_ablation.draw_ablation(COLUMNS, groups, self._path("ablation"), expert)
        yield self._picture("ablation")

    def _draw_paths(self, paths: list[DrivenPath] | tuple[DrivenPath, ...], name: str, *, columns: int) -> None:  # fmt: skip
        looks = self._looks
        pairs = [(replace(looks[it.arm], label=self._label(it.arm, it.seed)), it) for it in paths]
        figures_paths.draw_paths(pairs, self._town, self._path(name), columns=columns)

    def _draw_landscapes(self, records: list[LandscapeRecord], name: str) -> None:
        moments = list({it.moment.name: it.moment for it in records}.values())
        projector, parameters = BevProjector(self._town), VehicleParameters.default()
        views = [
            bev_picture.picture(
                moment.observe(projector).bev, projector.config, parameters, scale=VIEW_SCALE
            )
            for moment in moments
        ]
        rows: dict[str, list[Panel]] = {}
        for record in records:
            seen = from_record(record)
            rows.setdefault(self._label(record.arm, record.seed), []).append(
                (seen.probabilities, seen.draws)
            )
        titles = [moment.title for moment in moments]
        figures_landscape.draw_landscapes(titles, views, rows, self._path(name))

    def _label(self, arm: str, seed: int) -> str:
        """What an agent or a reference is called; the seed is said where several agents of an arm are shown."""
        label = self._looks[arm].label
        is_alone = len(self._config.detail_seeds) == 1 or arm in self._config.references
        return label if is_alone else f"{label}, seed {seed}"

    def _path(self, name: str) -> Path:
        return self._folder / PICTURES / f"{name}.png"

    def _picture(self, name: str, kind: str = "") -> Picture:
        title, caption = CAPTIONS[kind or name]
        return Picture(f"{PICTURES}/{name}.png", title, caption)
