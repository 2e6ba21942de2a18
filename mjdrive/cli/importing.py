"""`mjdrive import`: other people's demonstrations to learn from."""

from pathlib import Path

import rich_click as click

DATA = Path("data")


@click.command(name="import")
@click.argument("source", type=click.Path(path_type=Path), metavar="DIR")
@click.option(
    "--from",
    "kind",
    required=True,
    metavar="minari|carla-bc",
    help="What the folder holds.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="New folder for the data set. [default: data/<name of the folder>]",
)
@click.option("--overwrite", is_flag=True, help="Replace a data set that is there.")
def import_(*, source: Path, kind: str, out: Path | None, overwrite: bool) -> None:
    """Take demonstrations over as a data set for `mjdrive train --data`.

    They must say where the car was and when: views are drawn again from that. What is missing is named, and nothing is
    written then.
    """
    from mjdrive.cli.console import closing_table, progress_bars
    from mjdrive.exchange import importing

    folder = out or DATA / source.resolve().name
    read = importing.known(kind)
    importing.require_writable(folder, overwrite=overwrite)
    recordings = read(source)
    with progress_bars() as bars:
        task = bars.add_task(f"from {kind}", total=len(recordings), unit="episodes")
        manifest = importing.write(
            recordings,
            folder,
            origin=f"{kind} {source.resolve().name}",
            overwrite=overwrite,
            on_episode=lambda done: bars.update(task, completed=done),
        )
    closing_table(
        f"{len(recordings)} episodes from {kind}",
        {
            "town": manifest.town,
            "steps": f"{sum(it.steps for it in manifest.episodes):,}",
            "data set": folder,
        },
        next_command=f"mjdrive train da-ibc --data {folder}",
    )
