"""`mjdrive replay`: an episode drawn and driven again."""

from pathlib import Path
from typing import TYPE_CHECKING

import rich_click as click

if TYPE_CHECKING:
    from mjdrive.datatypes import Episode
    from mjdrive.recording.film import Landscape

RUNS, REPLAYS = Path("runs"), Path("replays")

VERDICT = "verification.json"
"""What came of driving the actions again."""


@click.command()
@click.argument("source", type=click.Path(path_type=Path), metavar="EPISODE")
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="New folder for pictures and video. [default: replays/<name of the drive>]",
)
@click.option(
    "--policy",
    metavar="RUN|zoo:NAME",
    help="Whose energy landscape the video shows. [default: that of the policy that drove, if it is here unchanged]",
)
@click.option(
    "--car",
    metavar="NAME|FILE.xml",
    help="Car that was driven, if it is one of your own. [default: what the episode says]",
)
@click.option("--video/--no-video", "is_filmed", default=True, help="Whether to write a video.")
@click.option(
    "--cameras/--no-cameras",
    "has_cameras",
    default=True,
    help="Whether the video shows the front cameras, which need OpenGL.",
)
def replay(
    *,
    source: Path,
    out: Path | None,
    policy: str | None,
    car: str | None,
    is_filmed: bool,
    has_cameras: bool,
) -> None:
    """Draw an episode again, and drive its actions again to see whether they lead to the same states.

    They do, bit by bit, where versions agree; where they do not, it is said from which step on, how far apart, and which
    versions differ.
    """
    from mjdrive import config
    from mjdrive.cli import filming
    from mjdrive.cli.console import closing_table, progress_bars
    from mjdrive.errors import DataError
    from mjdrive.evaluation import figures, report, timelines
    from mjdrive.exchange import sources
    from mjdrive.recording.playback import Playback
    from mjdrive.recording.verification import verify

    found = sources.find(source)
    if len(found) > 1:
        raise DataError(f"'{source}' holds {len(found)} episodes; expected one, as '{found[0]}'.")
    (recording,) = sources.read(source)
    episode, folder = recording.episode, out or REPLAYS / recording.name
    report.require_new(folder)
    if is_filmed and has_cameras:
        filming.require_cameras()
    landscape, note = _landscape(episode, policy) if is_filmed else (None, "")
    playback = Playback(episode, car=car)
    with progress_bars() as bars:
        task = bars.add_task("drive again", total=len(episode.time))
        verdict = verify(playback, on_step=lambda done: bars.update(task, completed=done))
    town = playback.simulation.town
    folder.mkdir(parents=True, exist_ok=True)
    figures.draw_trajectory(episode, town, folder / report.TRAJECTORY)
    timelines.draw_actions(episode, town, folder / report.ACTIONS)
    video: dict[str, object] = {}
    if is_filmed:
        path = folder / filming.VIDEO
        filming.write_video(playback, path, landscape=landscape, cameras=has_cameras)
        video = {"video": path, "energy in it": note}
    config.write_json(verdict, folder / VERDICT)
    closing_table(
        f"{episode.policy} in {episode.town}, seed {episode.seed}, {len(episode.time):,} steps",
        {
            "states": verdict.words,
            "path": folder / report.TRAJECTORY,
            "actions": folder / report.ACTIONS,
            **video,
            "verdict": folder / VERDICT,
        },
        next_command=f"mjdrive export {found[0]} --to html",
    )


def _landscape(episode: "Episode", name: str | None) -> "tuple[Landscape | None, str]":
    """What the policy of an episode, or one that is named, thinks of all actions; and whose it is, in words."""
    from mjdrive.cli.driver import find_driver
    from mjdrive.cli.filming import landscape_of
    from mjdrive.errors import RunError, UnknownNameError

    driven = episode.metadata.get("policy_digest", "")
    if name is None and not driven:
        return None, f"none: {episode.policy} thinks of one action alone"
    try:
        driver = find_driver(name or episode.policy, RUNS)
    except (RunError, UnknownNameError):
        if name is not None:
            raise
        return None, f"none: {episode.policy} is not here; name a policy with --policy"
    if name is None and driver.digest != driven:
        return (
            None,
            f"none: {episode.policy} is another network now; --policy shows it all the same",
        )
    whose = (
        "the policy that drove"
        if driver.digest == driven
        else f"{driver.name}, which did not drive"
    )
    return landscape_of(driver), f"of {whose}"
