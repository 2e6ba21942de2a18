import subprocess
import sys

IMPORT = """
import sys
import mjdrive.simulation.town_files, mjdrive.town.check, mjdrive.cli.town_tables
print(*sorted({"mujoco", "matplotlib", "torch", "casadi", "scipy", "h5py"} & sys.modules.keys()))
"""


def test_nothing_that_takes_long_to_load_is_needed_for_a_new_town() -> None:
    answer = subprocess.run(
        [sys.executable, "-c", IMPORT], check=True, capture_output=True, text=True
    )
    assert answer.stdout.split() == []
