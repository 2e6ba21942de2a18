"""Install the driving environments that `mjdrive bench` steps beside ours, each in a virtual environment of its own.

    python scripts/bench/install_rivals.py                # all of them into .rivals/ of the checkout
    python scripts/bench/install_rivals.py car_racing     # one of them

Versions are pinned in scripts/bench/rivals/<name>.txt. Takes 1.5 GB and one to five minutes, by the network.
"""

import os
import subprocess
import sys
import time
import venv
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import click

CHECKOUT = Path(__file__).resolve().parents[2]
WORLDS = Path(__file__).resolve().parent / "rivals"
NAMES = sorted(path.stem for path in WORLDS.glob("*.txt"))


def install(name: str, folder: Path) -> float:
    """Make the environment of one rival anew.

    Args:
        name: Of its file of requirements.
        folder: Where environments are.

    Returns:
        What that took [s].
    """
    begin = time.monotonic()
    environment = folder / name
    venv.EnvBuilder(clear=True, with_pip=True).create(environment)
    python = environment / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    subprocess.run(
        [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check",
         "--requirement", str(WORLDS / f"{name}.txt")],
        check=True,
    )  # fmt: skip
    return time.monotonic() - begin


@click.command()
@click.argument("names", nargs=-1, type=click.Choice(NAMES))
@click.option(
    "--folder", default=CHECKOUT / ".rivals", show_default=True, type=click.Path(path_type=Path)
)
def main(*, names: tuple[str, ...], folder: Path) -> None:
    """Install rivals."""
    wanted = names or NAMES
    print(f"Installing {', '.join(wanted)} into {folder} ...", flush=True)
    with ThreadPoolExecutor() as threads:  # most of it is waiting for the network
        jobs = {name: threads.submit(install, name, folder) for name in wanted}
    for name, job in jobs.items():
        try:
            print(f"{name}: {job.result():.0f} s")
        except subprocess.CalledProcessError as error:
            sys.exit(f"{name} could not be installed: pip ended with {error.returncode}.")


if __name__ == "__main__":
    main()
