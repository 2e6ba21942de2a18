"""`mjdrive view`: look at a drive in MuJoCo's own viewer."""

from contextlib import closing, suppress
from pathlib import Path

import rich_click as click

from mjdrive.cli.options import car_option


@click.command()
@click.option("--town", "town_name", required=True, metavar="NAME", help="Town to drive in.")
@click.option(
    "--policy",
    "policy_name",
    default="pid",
    show_default=True,
    metavar="RUN|pid|mpc|zoo:NAME",
    help="Who drives, as in `mjdrive drive`.",
)
@car_option
@click.option(
    "--steps",
    "num_steps",
    default=3000,
    show_default=True,
    type=click.IntRange(min=1),
    help="Control steps of 0.1 s.",
)
@click.option(
    "--seed",
    default=0,
    show_default=True,
    type=click.IntRange(0, 2**32 - 1),
    help="Same seed, same drive.",
)
@click.option(
    "--contacts/--no-contacts",
    default=True,
    show_default=True,
    help="Show contact points and forces from the beginning.",
)
def view(
    *,
    town_name: str,
    policy_name: str,
    car_name: str,
    num_steps: int,
    seed: int,
    contacts: bool,
) -> None:
    """Watch a drive in MuJoCo's viewer, in real time: contacts, forces, any body from any side.

    Nothing is written; `mjdrive drive` with the same seed and steps makes the same drive. Close the window to end it.
    """
    from mjdrive.cli.driver import find_driver
    from mjdrive.envs.window import require_display
    from mjdrive.town import library
    from mjdrive.vehicle import cars

    require_display()
    car = cars.load(car_name)
    town = library.load(town_name)
    driver = find_driver(policy_name, Path("runs"))

    from mjdrive.envs.viewer import Viewer, ViewerClosedError
    from mjdrive.simulation.simulation import Simulation

    simulation = Simulation(town, car=car)
    with closing(Viewer(simulation, contacts=contacts)) as viewer, suppress(ViewerClosedError):
        driver.drive(simulation, num_steps=num_steps, seed=seed, on_step=lambda done: viewer.show())
