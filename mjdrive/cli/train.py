"""`mjdrive train`: learn a policy from demonstrations."""

from pathlib import Path
from typing import TYPE_CHECKING, Literal

import rich_click as click

if TYPE_CHECKING:
    from models.progress import EpochReport, StepReport


@click.command()
@click.argument("method", metavar="METHOD")
@click.option(
    "--preset",
    default="standard",
    show_default=True,
    metavar="standard|quick|paper",
    help="What drives best (standard), minutes of training (quick), or the numbers of the paper.",
)
@click.option(
    "--set",
    "assignments",
    multiple=True,
    metavar="NAME=VALUE",
    help="Change one setting of the preset, as optimiser.epochs=5. May be given again.",
)
@click.option(
    "--data",
    type=click.Path(path_type=Path),
    default=Path("data/town01"),
    show_default=True,
    metavar="DIR",
    help="Demonstrations to learn from.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Run folder. [default: runs/<method>]",
)
@click.option(
    "--seed",
    default=0,
    show_default=True,
    type=click.IntRange(0, 2**32 - 1),
    help="Same seed, same weights.",
)
@click.option(
    "--resume", is_flag=True, help="Go on from the last complete epoch of the run folder."
)
@click.option("--overwrite", is_flag=True, help="Replace the run that is in the folder.")
@click.option(
    "--device",
    default="auto",
    show_default=True,
    metavar="auto|cpu|cuda|cuda:N",
    help="Where to train; auto takes a GPU where there is one.",
)
@click.option(
    "--views",
    type=click.Choice(["auto", "memory", "live"]),
    default="auto",
    show_default=True,
    help="Where the views are meanwhile: in memory, drawn when they are needed, or, with auto, in memory up to 2 GiB. The weights are the same.",
)
def train(
    *,
    method: str,
    preset: str,
    assignments: tuple[str, ...],
    data: Path,
    out: Path | None,
    seed: int,
    resume: bool,
    overwrite: bool,
    device: str,
    views: Literal["auto", "memory", "live"],
) -> None:
    """Train a policy on demonstrations.

    METHOD is bc-beta, bc-mixture or bc-grid (explicit densities), ibc, da-ibc or ibc-langevin (energies), diffusion or
    flow (noise turned into actions).

    A checkpoint is written after each epoch; an interrupted run goes on with --resume. Several processes share the
    work when torchrun starts them: torchrun --nproc-per-node 2 -m mjdrive train da-ibc
    """
    from mjdrive.cli.console import closing_table, progress_bars
    from mjdrive.learning.settings import learner_settings

    if resume and overwrite:
        raise click.UsageError("--resume goes on with a run and --overwrite replaces it: give one.")
    settings = learner_settings(method, preset=preset, assignments=assignments)
    run = out or Path("runs") / method
    from mjdrive.learning.training import find_team  # torch takes a second
    from mjdrive.learning.training import train as train_policy

    team = find_team()
    with progress_bars(visible=team.leads) as bars:
        drawing = bars.add_task("draw views", total=None, unit="views", visible=False)
        fitting = bars.add_task("train", total=None, visible=False)

        def on_step(report: "StepReport") -> None:
            text = f"train, loss {report.loss:.3f}"
            bars.update(
                fitting,
                completed=report.step,
                total=report.num_steps,
                description=text,
                visible=True,
            )

        reports: list[EpochReport] = train_policy(
            settings,
            data=data,
            run=run,
            seed=seed,
            resume=resume,
            overwrite=overwrite,
            device=device,
            views=views,
            team=team,
            on_note=bars.console.print if team.leads else None,
            on_frame=lambda done, total: bars.update(
                drawing, completed=done, total=total, visible=True
            ),
            on_step=on_step,
        )
    if not team.leads:
        return
    closing_table(
        f"{method}, preset {preset}",
        {
            "run": run,
            "epochs": len(reports),
            "loss": f"{reports[0].loss:.3f} -> {reports[-1].loss:.3f}",
            "training": f"{sum(report.duration_s for report in reports) / 60:.1f} min",
        },
        next_command="mjdrive drive --town town02 --steps 3000"
        + ("" if out is None else f" --policy {run}"),
    )
