"""`mjdrive tune`: fit the settings of an expert to a car."""

from pathlib import Path
from typing import TYPE_CHECKING

import rich_click as click

from mjdrive.cli.options import car_option

if TYPE_CHECKING:
    from mjdrive.tuning.gains import Evidence

TUNINGS = Path("tunings")


@click.command()
@click.argument("expert", metavar="pid|mpc", default="pid")
@car_option
@click.option(
    "--town", "town_name", default="town01", show_default=True, metavar="NAME", help="Where to try."
)
@click.option(
    "--check-town",
    "check_name",
    default="town02",
    show_default=True,
    metavar="NAME",
    help="Where the result is checked; the search never sees it.",
)
@click.option(
    "--trials",
    default=80,
    show_default=True,
    type=click.IntRange(min=2),
    help="Settings to try.",
)
@click.option(
    "--seed",
    default=0,
    show_default=True,
    type=click.IntRange(0, 2**31 - 2),
    help="Same seed, same settings.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="New folder for gains.json. [default: tunings/<expert>-<car>]",
)
def tune(
    *,
    expert: str,
    car_name: str,
    town_name: str,
    check_name: str,
    trials: int,
    seed: int,
    out: Path | None,
) -> None:
    """Fit the settings of an expert to a car.

    Drives bends of every shape and a start beside the lane, again and again with other settings, and writes the best
    with the evidence: `collect` and `drive` take them with --gains.
    """
    from mjdrive.cli.console import closing_table, progress_bars
    from mjdrive.config import TuneConfig
    from mjdrive.evaluation.report import require_new
    from mjdrive.town import library
    from mjdrive.tuning.knobs import default_settings
    from mjdrive.tuning.report import GAINS, PICTURE, write_tuning
    from mjdrive.tuning.search import Tried
    from mjdrive.tuning.tune import tune as tune_expert
    from mjdrive.vehicle import cars

    car = cars.load(car_name)
    settings = default_settings(expert)
    folder = out or TUNINGS / f"{expert}-{car.name}"
    require_new(folder)
    town, check_town = library.load(town_name), library.load(check_name)
    with progress_bars() as bars:
        task = bars.add_task(f"{expert} in {car.name}", total=trials, unit="trials")
        least = float("inf")

        def on_trial(tried: Tried) -> None:
            nonlocal least
            least = min(least, tried.marks.cost)
            bars.update(task, advance=1, description=f"{expert} in {car.name}, cost {least:.2f}")

        tuning = tune_expert(
            expert,
            settings,
            car=car,
            town=town,
            check_town=check_town,
            config=TuneConfig(trials=trials),
            seed=seed,
            on_trial=on_trial,
        )
    write_tuning(tuning, folder)
    gains = tuning.gains
    rows: dict[str, object] = {}
    for evidence in (gains.tuned_on, gains.checked_on):
        if evidence is not None:
            rows |= _compared(evidence)
    for name in gains.tuned:
        rows[name] = gains.settings[name]
    rows |= {"settings": folder / GAINS, "picture": folder / PICTURE}
    closing_table(
        f"{expert} tuned to car '{car.name}' in {gains.trials} trials",
        rows,
        next_command=f"mjdrive drive --town {check_name} --policy {expert} --gains {folder / GAINS}"
        + ("" if car_name == "default" else f" --car {car_name}"),
    )
    if gains.doubt:
        click.echo(gains.doubt, err=True)


def _compared(evidence: "Evidence") -> dict[str, str]:
    """Rows of how one town was driven before and after."""
    before, after, town = evidence.before, evidence.after, evidence.town
    return {
        f"{town}: cost": f"{before.cost:.2f} before, {after.cost:.2f} after",
        f"{town}: off the route": f"{before.offset_rms_m:.3f} and {after.offset_rms_m:.3f} m RMS",
        f"{town}: steering whiteness": f"{before.steering_whiteness:.2f} and {after.steering_whiteness:.2f} 1/s",
        f"{town}: mishaps": f"{before.mishaps} and {after.mishaps}",
    }
