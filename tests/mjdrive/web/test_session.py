"""A drive by hand becomes a demonstration that training accepts, and names are never paths."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from mjdrive.datatypes import Action
from mjdrive.episodes import dataset
from mjdrive.errors import DataError, UnknownNameError
from mjdrive.page import wire
from mjdrive.page.replaying import episode_message, view_at
from mjdrive.town import signals
from mjdrive.web.choices import load_mind
from mjdrive.web.policies import DEPTH, shade
from mjdrive.web.recording import HUMAN, SOURCE
from mjdrive.web.session import Choice, Session
from mjdrive.web.telling import panel_message, pose_message

TOWN = "town03"


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Session:
    folder = tmp_path_factory.mktemp("session")
    return Session(Choice(TOWN, "pid", 0), runs=folder / "runs", data=folder / "data")


def drive(session: Session, steps: int) -> None:
    for _ in range(steps):
        session.step(Action(acceleration=0.3, steering=0.0), on_motion=lambda: None, by_hand=True)


def test_the_car_is_told_to_move_fifty_times_a_second(session: Session) -> None:
    session.reset()
    beats: list[int] = []
    session.step(Action(0.0, 0.0), on_motion=lambda: beats.append(1))
    config = session.simulation.config
    assert len(beats) == round(config.control_interval / config.car_update_interval)


def test_what_is_driven_by_hand_is_a_data_set_that_training_reads(session: Session) -> None:
    session.reset()
    session.begin_recording()
    drive(session, 15)
    first = session.keep_recording()
    drive(session, 12)
    session.keep_recording()
    manifest, episodes = dataset.read_dataset(first.parent)
    assert [len(it.time) for it in episodes] == [15, 12]
    assert manifest.settings == {SOURCE: HUMAN}
    assert {it.metadata[SOURCE] for it in episodes} == {HUMAN}
    np.testing.assert_array_equal(episodes[0].labels[:, 0], 0.3)
    assert np.all(np.diff(episodes[0].vehicle[:, 3]) >= 0.0)


def test_what_the_policy_drives_is_not_recorded_as_driven_by_hand(session: Session) -> None:
    session.reset()
    session.begin_recording()
    drive(session, 4)
    session.step(session.decide().action, on_motion=lambda: None)
    assert session.recording is not None
    assert len(session.recording) == 4


def test_hardly_a_drive_is_not_kept(session: Session) -> None:
    session.reset()
    session.begin_recording()
    drive(session, 3)
    with pytest.raises(DataError, match="3 steps"):
        session.keep_recording()


def test_a_replay_shows_the_car_where_it_was(session: Session) -> None:
    session.reset()
    session.begin_recording()
    drive(session, 20)
    assert session.recording is not None
    episode = session.recording.episode()
    _, blobs = wire.unpack(episode_message(episode, "x"))
    np.testing.assert_allclose(blobs["poses"][:, 0, :2], episode.vehicle[:, :2], atol=1e-3)
    assert blobs["rows"].shape == (20, 6)


def test_a_replay_shows_the_lights_as_they_were(session: Session) -> None:
    session.reset()
    session.begin_recording()
    lights = []
    for _ in range(20):
        lights.append(list(session.simulation.lights.values()))
        drive(session, 1)
    assert session.recording is not None
    cycle = signals.cycle(session.simulation.town)
    _, blobs = wire.unpack(episode_message(session.recording.episode(), "x"))
    assert blobs["lights"].tolist() == lights
    assert blobs["lights"].shape == (20, len(session.simulation.town.lights))
    later = dataclasses.replace(session.recording.episode(), light_phase=0.3 * cycle)
    _, blobs = wire.unpack(episode_message(later, "x"))
    expected = signals.all_at(session.simulation.town, float(later.time[0]) + 0.3 * cycle)
    assert blobs["lights"][0].tolist() == list(expected.values())


def test_a_replay_in_a_town_that_has_changed_is_refused(session: Session) -> None:
    session.reset()
    session.begin_recording()
    drive(session, 10)
    assert session.recording is not None
    episode = session.recording.episode()
    old = dataclasses.replace(episode, metadata={**episode.metadata, "town_digest": "of another"})
    for show in (lambda: episode_message(old, "x"), lambda: view_at(old, 3)):
        with pytest.raises(DataError, match="another map"):
            show()


def test_the_same_seed_drives_the_same(session: Session) -> None:
    ends = []
    for _ in range(2):
        session.reset()
        for _ in range(10):
            session.step(session.decide().action, on_motion=lambda: None)
        ends.append(session.simulation.car.save().tobytes())
    assert ends[0] == ends[1]


def test_messages_of_one_decision_carry_its_tick(session: Session) -> None:
    session.reset()
    drive(session, 2)
    decision = session.decide()
    driven = Action(0.5, -0.25)
    message = panel_message(session, decision, None, None, driven=driven, by_hand=False)
    head, blobs = wire.unpack(message)
    assert head["tick"] == len(blobs["rows"]) == 2
    assert head["driven"] == [0.5, -0.25]
    np.testing.assert_array_equal(blobs["bev"], decision.observation.bev)
    assert len(blobs["lights"]) == len(session.simulation.town.lights)
    pose, poses = wire.unpack(pose_message(session, seq=0, rate=1.0))
    assert pose["t"] == pytest.approx(head["t"])
    assert poses["q"].shape == (session.simulation.model.nbody - 1, 7)


@pytest.mark.parametrize("name", ["../runs", "/etc", ".", "", "a/b", "zoo:../x"])
def test_policies_have_names_and_no_paths(name: str, tmp_path: Path) -> None:
    with pytest.raises(UnknownNameError):
        load_mind(name, tmp_path)


def test_a_load_that_fails_leaves_the_drive_as_it_was(session: Session) -> None:
    before = session.choice
    for choice in (Choice("nowhere", "pid", 0), Choice(TOWN, "nobody", 0)):
        with pytest.raises(UnknownNameError):
            session.load(choice)
    assert session.choice == before


def test_a_landscape_keeps_the_order_of_densities_and_ends_at_its_depth() -> None:
    pixels, low, high = shade(np.array([[0.0, -DEPTH / 2], [-DEPTH, -5 * DEPTH]]))
    assert pixels.tolist() == [[255, 128], [0, 0]]
    assert (low, high) == (-5 * DEPTH, 0.0)
