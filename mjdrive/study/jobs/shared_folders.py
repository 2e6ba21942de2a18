"""Whether those who work see the folders that agents are trained in and learn from: a run of hours is kept epoch by epoch there."""

import platform
import secrets
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path

from mjdrive import versions
from mjdrive.episodes import dataset, store
from mjdrive.errors import WorkerError
from mjdrive.execution.work import Executor, Tell
from mjdrive.files import write_atomically
from models.errors import HardwareError
from models.hardware import choose_device


@dataclass(frozen=True, slots=True)
class SharedFolders:
    """Files by which one knows the folders of a study on any machine, however many machines have folders of these names.

    Attributes:
        digests: SHA-256 of each file, hexadecimal.
    """

    digests: Mapping[Path, str]

    def unseen(self) -> Path | None:
        """The first folder that this machine does not see; None if it sees all."""
        for file, digest in self.digests.items():
            if not file.is_file() or store.digest(file.read_bytes()) != digest:
                return file.parent
        return None

    def require_seen(self) -> None:
        """Refuse to work where a folder is not seen.

        Raises:
            WorkerError: If one is not.
        """
        unseen = self.unseen()
        if unseen is not None:
            raise WorkerError(
                f"The machine '{platform.node()}' does not see '{unseen}', which others that train see. Expected a file "
                f"system that all of them share. Leave that machine out of the cluster, or go on with --backend local."
            )


@contextmanager
def marked(runs: Path, data: Iterable[Path]) -> Iterator[SharedFolders]:
    """Make folders known; within it, a file in the first one is like no other.

    Args:
        runs: Folder where agents are trained; made if missing.
        data: Data folders that they learn from.

    Raises:
        DataError: If a data folder is missing, or no data set.
    """
    digests = {}
    for folder in data:
        dataset.read_manifest(folder)
        digests[folder / dataset.MANIFEST] = dataset.digest(folder)
    mark = runs / f".seen-{secrets.token_hex(8)}"
    write_atomically(mark, mark.name.encode())
    try:
        yield SharedFolders({mark: store.digest(mark.read_bytes()), **digests})
    finally:
        mark.unlink(missing_ok=True)


def why_not_there(
    folders: SharedFolders, device: str, versions: Mapping[str, str], executor: Executor
) -> str | None:
    """Ask one of those who work for an executor whether agents can be trained there.

    Args:
        folders: What has to be seen.
        device: Kind of device that trains, "cpu" or "cuda".
        versions: Of the software where training was asked for.
        executor: Whose machines.

    Returns:
        In words what is in the way; None if nothing is.

    Raises:
        WorkerError: If that machine has other versions, or was lost.
    """
    work = _Looking(folders, device, versions)
    with closing(executor.run(work, [_Look()], on_progress=lambda job, done: None)) as results:
        ((_, obstacle),) = results  # to the end, where executors clean up
    return obstacle


@dataclass(frozen=True, slots=True)
class _Look:
    """One look at the folders."""

    name: str = "look for the folders of the study"


@dataclass(frozen=True, slots=True)
class _Looking:
    """Looks for what training needs."""

    folders: SharedFolders
    device: str
    versions: Mapping[str, str]

    def begin(self) -> Callable[[_Look, Tell], str | None]:
        """Make sure of the versions; what comes back says what is in the way of training here."""
        versions.require_same(self.versions)
        return lambda job, tell: self._obstacle()

    def _obstacle(self) -> str | None:
        unseen = self.folders.unseen()
        if unseen is not None:
            return f"the machine '{platform.node()}' of the cluster does not see '{unseen}'"
        try:
            choose_device(self.device)
        except HardwareError:
            return f"the jobs of the cluster on '{platform.node()}' have no device '{self.device}', which this machine has"
        return None
