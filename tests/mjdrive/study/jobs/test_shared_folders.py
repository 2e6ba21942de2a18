"""Whether a machine sees the folders of a study."""

from pathlib import Path

import pytest
import torch

from mjdrive import versions
from mjdrive.errors import DataError, WorkerError
from mjdrive.execution.serial import SerialExecutor
from mjdrive.execution.slurm import SlurmExecutor
from mjdrive.study.jobs import shared_folders
from mjdrive.study.jobs.shared_folders import SharedFolders, marked, why_not_there


@pytest.fixture
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Looks like a data set."""
    monkeypatch.setattr(shared_folders.dataset, "read_manifest", lambda folder: None)
    (tmp_path / "data").mkdir()
    (tmp_path / "data/manifest.json").write_text("{}")
    return tmp_path / "data"


def obstacle(folders: SharedFolders, device: str = "cpu") -> str | None:
    return why_not_there(folders, device, versions.all_versions(), SerialExecutor())


def test_folders_are_seen_while_they_are_marked_and_nothing_stays_behind(
    tmp_path: Path, data: Path
) -> None:
    with marked(tmp_path / "runs", [data]) as folders:
        assert obstacle(folders) is None
        folders.require_seen()
        (mark,) = (tmp_path / "runs").iterdir()
        mark.write_text("another study")  # as if the other machine had a folder of that name
        assert f"does not see '{tmp_path / 'runs'}'" in str(obstacle(folders))
        with pytest.raises(WorkerError, match=r"does not see .*runs.*--backend local"):
            folders.require_seen()
    assert list((tmp_path / "runs").iterdir()) == []


def test_slurm_is_asked_without_leaving_anything(tmp_path: Path, data: Path) -> None:
    executor = SlurmExecutor(cluster="local", folder=tmp_path / "slurm", poll=0.1)
    with marked(tmp_path / "runs", [data]) as folders:
        assert why_not_there(folders, "cpu", versions.all_versions(), executor) is None
    assert sorted(path.name for path in tmp_path.iterdir()) == ["data", "runs"]


def test_other_data_of_that_name_is_not_seen(tmp_path: Path, data: Path) -> None:
    with marked(tmp_path / "runs", [data]) as folders:
        (data / "manifest.json").write_text('{"town": "another"}')
        assert f"does not see '{data}'" in str(obstacle(folders))


def test_a_missing_data_set_is_named(tmp_path: Path) -> None:
    with (
        pytest.raises(DataError, match=r"Data folder .*nowhere' does not exist"),
        marked(tmp_path / "runs", [tmp_path / "nowhere"]),
    ):
        pass
    assert not (tmp_path / "runs").exists()


def test_a_cluster_without_the_device_is_not_where_agents_are_trained(
    tmp_path: Path, data: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    with marked(tmp_path / "runs", [data]) as folders:
        assert "have no device 'cuda', which this machine has" in str(obstacle(folders, "cuda"))


def test_a_machine_of_other_versions_is_refused(tmp_path: Path, data: Path) -> None:
    with (
        marked(tmp_path / "runs", [data]) as folders,
        pytest.raises(WorkerError, match=r"expected mujoco 1\.50"),
    ):
        why_not_there(folders, "cpu", {"mujoco": "1.50"}, SerialExecutor())
