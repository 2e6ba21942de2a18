"""What a page can choose by name, also of what other packages bring along."""

from pathlib import Path

import numpy as np
import pytest

from mjdrive.errors import PluginError
from mjdrive.web.choices import load_mind, policy_names
from mjdrive.web.session import Choice, Session
from models import checkpoint


def test_runs_that_links_lead_out_to_are_not_listed(tmp_path: Path) -> None:
    outside, runs = tmp_path / "outside", tmp_path / "runs"
    for folder in (outside, runs / "inside", runs / ".hidden"):
        folder.mkdir(parents=True)
        (folder / checkpoint.STATE).write_text("{}")
    (runs / "link").symlink_to(outside)
    assert policy_names(runs)[0] == "inside"
    assert not {"link", ".hidden"} & set(policy_names(runs))


@pytest.fixture
def example(example_package: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The example package, found from here."""
    monkeypatch.syspath_prepend(example_package)
    return example_package


@pytest.mark.parametrize("name", ["example-policy", "example-expert"])
def test_policies_and_experts_of_other_packages_are_driven_like_ours(
    name: str, example: Path, session: Session
) -> None:
    assert name in policy_names(session.runs)
    session.load(Choice(session.choice.town, name, 3))
    assert session.mind.name == name
    start = session.simulation.vehicle
    for _ in range(30):
        decision = session.decide()
        assert decision.action is not None
        session.step(decision.action, on_motion=lambda: None)
    end = session.simulation.vehicle
    assert np.hypot(end.x - start.x, end.y - start.y) > 2.0
    assert (session.mind.density(decision.observation), session.mind.points()) == (None, None)
    session.mind.take_over(session.simulation)
    assert session.decide().action is not None
    assert not session.infractions


def test_a_name_of_ours_cannot_be_taken_and_is_listed_once(tmp_path: Path) -> None:
    for name in ("pid", "own"):
        (tmp_path / name).mkdir()
        (tmp_path / name / checkpoint.STATE).write_text("{}")
    names = policy_names(tmp_path)
    assert names.count("pid") == 1
    assert names[:2] == ("own", "pid")
    assert load_mind("pid", tmp_path).name == "pid"


def test_a_policy_of_a_broken_package_is_refused_by_name_and_the_drive_goes_on(
    tmp_path: Path, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    about = tmp_path / "mute-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: mute\nVersion: 1.0\n")
    entries = "[mjdrive.policies]\nmute = builtins:int\n[mjdrive.experts]\ngone = builtins:gone\n"
    (about / "entry_points.txt").write_text(entries)
    monkeypatch.syspath_prepend(tmp_path)
    before = session.choice
    for name, words in {
        "mute": "policy 'mute' of mute 1.0 is a int; expected name",
        "gone": "expert 'gone' of mute 1.0 cannot be imported: AttributeError",
    }.items():
        with pytest.raises(PluginError, match=words):
            session.load(Choice(before.town, name, 0))
    assert (session.choice, session.mind.name) == (before, before.policy)
