import pytest

from mjdrive.benchmarks.start_up import imported_by


@pytest.mark.parametrize(
    ("program", "loaded"), [("import mujoco", ("mujoco",)), ("import mjdrive", ()), ("1", ())]
)
def test_heavy_imports_are_noticed(program: str, loaded: tuple[str, ...]) -> None:
    assert imported_by(program) == loaded
