"""Options that several commands share."""

import pytest

from mjdrive.cli.options import chosen_executor
from mjdrive.execution.pool import PoolExecutor, available_cores


@pytest.mark.usefixtures("on_one_core")
def test_more_processes_than_cores_are_made_with_a_note(capsys: pytest.CaptureFixture[str]) -> None:
    executor = chosen_executor(8, "local", None)
    assert isinstance(executor, PoolExecutor)
    assert executor.num_processes == 8
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.count("\n") == 1
    assert shown.err.startswith("--jobs 8 is more than the 1 core that there is for mjdrive here:")
    assert "--jobs auto takes 1." in shown.err


@pytest.mark.usefixtures("on_one_core")
def test_auto_takes_one_process_of_one_core_without_a_word(
    capsys: pytest.CaptureFixture[str],
) -> None:
    for jobs in (None, 1, "auto"):
        executor = chosen_executor(jobs, "local", None)
        assert getattr(executor, "num_processes", 1) == 1
    assert capsys.readouterr() == ("", "")


def test_as_many_processes_as_cores_need_no_note(capsys: pytest.CaptureFixture[str]) -> None:
    chosen_executor(available_cores(), "local", None)
    assert capsys.readouterr() == ("", "")
    chosen_executor(available_cores() + 1, "local", None)
    assert "more than" in capsys.readouterr().err
