import os
from pathlib import Path

import pytest

from mjdrive.files import write_atomically


def test_write_leaves_the_content_and_nothing_else(tmp_path: Path) -> None:
    write_atomically(tmp_path / "new" / "file.txt", b"whole")
    assert (tmp_path / "new" / "file.txt").read_bytes() == b"whole"
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["file.txt"]


def test_write_respects_the_permission_mask(tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        write_atomically(tmp_path / "file.txt", b"")
    finally:
        os.umask(before)
    assert (tmp_path / "file.txt").stat().st_mode & 0o777 == 0o640


def test_interrupted_write_keeps_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "file.txt"
    path.write_bytes(b"old")

    def interrupt(handle: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_atomically(path, b"new")
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]
