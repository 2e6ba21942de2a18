"""Policies are chosen by a name in the list, and loading one runs nothing that it brings along."""

import pickle
import shutil
from pathlib import Path

import pytest

from mjdrive.errors import RunError
from mjdrive.web.policies import load_mind, policy_names
from mjdrive.zoo import entries
from models import checkpoint


def test_runs_that_links_lead_out_to_are_not_listed(tmp_path: Path) -> None:
    outside, runs = tmp_path / "outside", tmp_path / "runs"
    for folder in (outside, runs / "inside", runs / ".hidden"):
        folder.mkdir(parents=True)
        (folder / checkpoint.STATE).write_text("{}")
    (runs / "link").symlink_to(outside)
    assert policy_names(runs)[0] == "inside"
    assert not {"link", ".hidden"} & set(policy_names(runs))


def test_weights_are_never_a_pickle(tmp_path: Path) -> None:
    class Trap:
        def __reduce__(self) -> tuple[object, ...]:
            return (tmp_path.joinpath("sprung").touch, ())

    run = tmp_path / "runs" / "trap"
    shutil.copytree(entries.FOLDER / entries.DEFAULT, run)
    for name in (checkpoint.MODEL, checkpoint.TRAINING):
        (run / name).write_bytes(pickle.dumps(Trap()))
    with pytest.raises(RunError):
        load_mind("trap", run.parent)
    assert not (tmp_path / "sprung").exists()
    pickle.loads((run / checkpoint.MODEL).read_bytes())
    assert (tmp_path / "sprung").exists()  # it would have
