"""What tests of several rooms share: a drive of a second and a half, a cluster, and a package of somebody else."""

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from mjdrive.cli.driver import find_driver
from mjdrive.datatypes import Episode, Town
from mjdrive.simulation.simulation import Simulation

MEGABYTE = 2**20
EXAMPLE = Path(__file__).parents[2] / "examples" / "mjdrive-example"


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Let one process run all tests on Ray, so that they share one cluster.

    First, because what hands out tests to processes reads the groups in the same hook.
    """
    for item in items:
        if "ray_address" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.xdist_group("ray"))


@pytest.fixture(scope="session")
def ray_address() -> Iterator[str]:
    """Head of a cluster of two nodes of one core on this machine; small, as CI has little shared memory."""
    from ray.cluster_utils import Cluster  # noqa: PLC0415 - takes a second, and few need it

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")  # or Ray warns of its future
        patch.setenv("RAY_OBJECT_STORE_ALLOW_SLOW_STORAGE", "1")
        node = {"num_cpus": 1, "object_store_memory": 80 * MEGABYTE, "include_dashboard": False}
        cluster = Cluster(initialize_head=True, head_node_args=node)
        try:
            cluster.add_node(**node)
            yield cluster.address
        finally:
            cluster.shutdown()


@pytest.fixture(scope="session")
def example_package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the example package, installed outside the repository, to be put first in PYTHONPATH."""
    site = tmp_path_factory.mktemp("site")
    words = ["install", "--quiet", "--no-deps", "--no-build-isolation", "--no-index"]
    subprocess.run(
        [sys.executable, "-m", "pip", *words, "--target", str(site), str(EXAMPLE)], check=True
    )
    return site


@pytest.fixture(scope="session")
def short_drive(town02: Town) -> Episode:
    """Fifteen steps of the PID expert in town02, as `mjdrive drive` records them."""
    driver = find_driver("pid", Path("runs"))
    return driver.drive(Simulation(town02), num_steps=15, seed=3, on_step=lambda done: None)
