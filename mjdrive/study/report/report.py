"""`report.html`: a whole study on one page that needs nothing else, made from its JSON files, pictures and videos."""

import base64
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import resources
from pathlib import Path

import jinja2

from mjdrive.config import to_json
from mjdrive.errors import DataError
from mjdrive.files import write_atomically
from mjdrive.study.pictures.captions import CAPTIONS, TABLES
from mjdrive.study.pictures.figure_looks import looks
from mjdrive.study.pictures.pictures import draw_pictures
from mjdrive.study.records.reading import StudyFiles, read_study
from mjdrive.study.tables import tables
from mjdrive.study.tables.report_tables import Table, read_markdown
from mjdrive.study.videos.videos import video_file
from mjdrive.town import library

REPORT = "report.html"
TEMPLATE = "report.html.jinja"

MEDIA = {".png": "image/png", ".mp4": "video/mp4"}
"""What a browser is told of each kind of file."""


@dataclass(frozen=True, slots=True)
class Figure:
    """A picture, video or table on the page.

    Attributes:
        anchor: Name that links of the page lead to.
        title: What it is called.
        caption: What it shows.
        file: Where the study has it.
        image: The picture as a data URI; empty if it is none.
        video: The video likewise.
        table: The table; None if it is none.
    """

    anchor: str
    title: str
    caption: str
    file: str
    image: str = ""
    video: str = ""
    table: Table | None = None


def write_report(folder: Path) -> Path:
    """Draw the pictures of a study and put everything on one page.

    Args:
        folder: Of a study whose results are there; its drives and weights are not needed.

    Returns:
        The page.

    Raises:
        ConfigError: If a JSON file is missing or damaged.
        DataError: If the town is another than the one that was driven in.
    """
    study = read_study(folder)
    config = study.record.settings
    town = library.load(config.town)
    if town.digest != study.record.towns[town.name]:
        raise DataError(
            f"The study in '{folder}' was driven in another {town.name} (digest {study.record.towns[town.name][:12]}); "
            f"here it is {town.digest[:12]}. Expected the same, to draw its map. Take the version that drove."
        )
    tables.write_tables(folder)
    sections = {
        "Results": [*_tables(folder)],
        "Pictures": [
            Figure(
                _anchor(it.file), it.title, it.caption, it.file, image=embedded(folder / it.file)
            )
            for it in draw_pictures(study, town, folder)
        ],
        "Videos": [*_videos(study, folder)],
    }
    page = _template().render(
        config=config,
        command=study.record.command or "mjdrive.study.study.Study, with the settings below",
        sections={title: figures for title, figures in sections.items() if figures},
        facts=_facts(study),
        settings=to_json(study.record),
    )
    write_atomically(folder / REPORT, page.encode())
    return folder / REPORT


def embedded(path: Path) -> str:
    """The content of a picture or video as a data URI."""
    content = base64.b64encode(path.read_bytes()).decode("ascii")
    return f"data:{MEDIA[path.suffix]};base64,{content}"


def _tables(folder: Path) -> Iterator[Figure]:
    for name, (title, caption) in TABLES.items():
        file = f"{tables.TABLES}/{name}"
        table = read_markdown((folder / file).read_text())
        if table is not None:
            yield Figure(_anchor(file), title, caption, file, table=table)


def _videos(study: StudyFiles, folder: Path) -> Iterator[Figure]:
    named = looks(study.record.settings)
    title, caption = CAPTIONS["video"]
    for arm, seed in dict.fromkeys((it.arm, it.seed) for it in study.results.turns):
        file = video_file(arm, seed)
        if (folder / file).is_file():
            name = f"{title}: {named[arm].label}, seed {seed}"
            yield Figure(_anchor(file), name, caption, file, video=embedded(folder / file))


def _anchor(file: str) -> str:
    """A name for links, such as "pictures-fans"."""
    return file.rpartition(".")[0].replace("/", "-")


def _facts(study: StudyFiles) -> dict[str, str]:
    """What decides the results, in words."""
    record, config = study.record, study.record.settings
    return {
        "demonstrations": f"{', '.join(f'{it.name} ({it.samples:,} samples)' for it in study.results.data)} "
        f"in {config.learning_town}",
        "driven in": f"{config.town}, which no agent has seen" if config.town != config.learning_town else config.town,
        "training seeds": ", ".join(map(str, config.seeds)),
        "drives of each agent": f"{config.episodes} of {config.steps:,} steps, seed {config.seed}",
        "long drive": f"{config.long_steps:,} steps" if config.long_steps else "none",
        **{f"digest of {name}": digest for name, digest in record.towns.items()},
        "digest of the car": record.car,
        **{f"version of {name}": version for name, version in record.versions.items()},
    }  # fmt: skip


def _template() -> jinja2.Template:
    text = resources.files("mjdrive.study.report").joinpath(TEMPLATE).read_text()
    environment = jinja2.Environment(
        autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined
    )
    return environment.from_string(text)
