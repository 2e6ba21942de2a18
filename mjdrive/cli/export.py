"""`mjdrive export`: drives for other people's tools."""

from pathlib import Path

import rich_click as click

EXPORTS = Path("exports")

READERS = {
    "html": "open {path} in a browser, or show mjdrive.exchange.html.page.EpisodePage(episode) in a notebook",
    "minari": "python -c \"import minari; print(minari.MinariDataset('{path}'))\"",
    "lerobot": "LeRobotDataset('mjdrive/drives', root='{path}')",
    "mcap": "open {path} in Foxglove or Lichtblick",
    "rerun": "rerun {path}",
}
"""How each format is looked at."""


@click.command()
@click.argument("source", type=click.Path(path_type=Path), metavar="EPISODE_OR_FOLDER")
@click.option(
    "--to",
    "name",
    required=True,
    metavar="html|minari|lerobot|mcap|rerun",
    help="html: one page a drive that needs no network. minari, lerobot: a data set. mcap: for Foxglove. rerun: for its viewer.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="PATH",
    help="A new folder; for html, mcap and rerun of one drive also a file. [default: exports/<name>-<format>]",
)
@click.option(
    "--car",
    metavar="NAME|FILE.xml",
    help="Car that was driven, if it is one of your own. [default: what each episode says]",
)
@click.option("--overwrite", is_flag=True, help="Replace an export that is there.")
def export(*, source: Path, name: str, out: Path | None, car: str | None, overwrite: bool) -> None:
    """Write an episode, a drive, or a folder of them in another project's format.

    What the policy saw is drawn again, so town and car must be those that were driven. docs/recordings.md says what each
    format holds and how to read it.
    """
    from mjdrive.cli.console import closing_table, progress_bars
    from mjdrive.exchange import formats, sources

    to = formats.known(name)
    files = sources.find(source)
    out = out or EXPORTS / f"{source.resolve().stem}-{name}"
    formats.require_writable(len(files), to, out, overwrite=overwrite)
    recordings = sources.read(source, car=car)
    steps = sum(len(it.episode.time) for it in recordings)
    with progress_bars() as bars:
        task = bars.add_task(f"{len(recordings)} to {name}", total=steps)
        written = formats.export(
            recordings,
            to,
            out,
            overwrite=overwrite,
            on_step=lambda done: bars.update(task, completed=done),
        )
    closing_table(
        f"{len(recordings)} drive{'' if len(recordings) == 1 else 's'} to {name}",
        {
            "steps": f"{steps:,}",
            "towns": ", ".join(sorted({it.episode.town for it in recordings})),
            "size": f"{_size(written) / 1e6:,.1f} MB",
            "to read it": READERS[name].format(path=written[0]),
            "written": out,
        },
        next_command=f"mjdrive replay {files[0]}",
    )


def _size(paths: tuple[Path, ...]) -> int:
    """Bytes of files and folders."""
    files = (it for path in paths for it in ([path] if path.is_file() else path.rglob("*")))
    return sum(it.stat().st_size for it in files if it.is_file())
