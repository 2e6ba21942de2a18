"""`mjdrive car`: what the car can do, and how it compares."""

from collections.abc import Callable
from pathlib import Path

import rich_click as click

TESTS = Path("car_tests")
COMPARISONS = Path("car_comparisons")
EXIT_BELOW_BAR = 1

_car = click.option(
    "--car",
    "car_name",
    default="default",
    show_default=True,
    metavar="NAME|FILE.xml",
    help="A car that comes with mjdrive (default, mkz), or an MJCF file of your own.",
)


@click.group()
def car() -> None:
    """Test the car on standard manoeuvres, or compare it with models of cars."""


@car.command("test")
@_car
@click.option("--plot", is_flag=True, help="Draw the curves, too.")
@click.option(
    "--quick", is_flag=True, help="Fewer seeds and obstacles: minutes, not a quarter of an hour."
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="New folder for report and pictures. [default: car_tests/<date and time>]",
)
@click.pass_context
def run_tests(
    context: click.Context, *, car_name: str, plot: bool, quick: bool, out: Path | None
) -> None:
    """Drive standard manoeuvres and hold every figure against its bar.

    Acceleration, braking, steady circles (ISO 4138), step steer (ISO 7401), standstill on slopes, full lock, every
    junction of town02, smaller timesteps, random driving, ramming, equal bytes and cost. The exit status is 1 if a bar
    does not hold.
    """
    import datetime

    from mjdrive.cli.car_tables import bars_table
    from mjdrive.cli.console import progress_bars
    from mjdrive.evaluation import report as folders
    from mjdrive.manoeuvres import suite
    from mjdrive.manoeuvres.bars import failed
    from mjdrive.vehicle import cars

    model = cars.load(car_name)
    folder = out or folders.new_folder(TESTS, datetime.datetime.now())
    folders.require_new(folder)
    with progress_bars() as bars:

        def track(name: str, count: int) -> Callable[[], None]:
            task = bars.add_task(name, total=count, unit="parts")
            return lambda: bars.advance(task)

        report = suite.run(model, suite.QUICK if quick else suite.Plan(), track)
    suite.write_report(report, folder / "report.json")
    pictures: tuple[Path, ...] = ()
    if plot:
        from mjdrive.manoeuvres import figures

        pictures = figures.draw(report.handling, folder)
    bars_table(report, [folder / "report.json", *pictures])
    if failed(report.bars):
        context.exit(EXIT_BELOW_BAR)


@car.command("compare")
@_car
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="New folder for figures and picture. [default: car_comparisons/<date and time>]",
)
def compare(*, car_name: str, out: Path | None) -> None:
    """Put the car beside models of cars: kinematic, linear single-track, and CommonRoad's multi-body BMW 320i.

    The single-track models have the numbers of the car. For the multi-body model our laws of motion take the numbers of
    the BMW; it needs the package commonroad-vehicle-models.
    """
    import datetime

    from mjdrive.cli.car_tables import comparison_table, say_missing
    from mjdrive.cli.console import progress_bars
    from mjdrive.evaluation import report as folders
    from mjdrive.manoeuvres import comparison, comparison_figure, multi_body
    from mjdrive.vehicle import cars

    model = cars.load(car_name)
    folder = out or folders.new_folder(COMPARISONS, datetime.datetime.now())
    folders.require_new(folder)
    with_bmw = multi_body.is_installed()
    with progress_bars() as bars:
        count = comparison.NUM_MANOEUVRES
        task = bars.add_task(f"{model.name}, two models", total=3 * count, unit="manoeuvres")
        compared = [comparison.compare(model, lambda: bars.advance(task))]
        if with_bmw:
            task = bars.add_task("BMW 320i, three models", total=4 * count, unit="manoeuvres")
            compared.append(comparison.compare_bmw(lambda: bars.advance(task)))
    comparison.write(compared, folder / "comparison.json")
    comparison_figure.draw(compared, folder / "comparison.png")
    for result in compared:
        comparison_table(result)
    if not with_bmw:
        say_missing(multi_body.PACKAGE, "CommonRoad's multi-body BMW 320i")
    click.echo(f"Picture: {folder / 'comparison.png'}")
