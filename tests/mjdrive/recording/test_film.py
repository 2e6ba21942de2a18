"""Frames of a drive; those with cameras need OpenGL, and only one test pays for them."""

import dataclasses

import numpy as np
import pytest

from mjdrive.bev import picture as bev_picture
from mjdrive.config import BevConfig
from mjdrive.datatypes import Episode, Infraction, InfractionKind, Observation
from mjdrive.errors import RenderError
from mjdrive.recording import film
from mjdrive.recording.pages import GAP, HEAD, LABEL
from mjdrive.recording.panels import PANEL
from mjdrive.recording.playback import Playback

TOP = HEAD + LABEL


def first(episode: Episode, count: int) -> Episode:
    arrays = ("time", "physics", "vehicle", "actions", "labels", "on_lane")
    return dataclasses.replace(episode, **{name: getattr(episode, name)[:count] for name in arrays})


def drawn(playback: Playback, episode: Episode, **how: object) -> list[np.ndarray]:
    """All frames of an episode of the same world."""
    before, playback.episode = playback.episode, episode
    try:
        return list(film.frames(playback, cameras=False, **how))
    finally:
        playback.episode = before


def panel(frame: np.ndarray, column: int) -> np.ndarray:
    """One of the lower pictures, without its outline."""
    left = GAP + column * (PANEL + GAP)
    return frame[TOP : TOP + PANEL, left : left + PANEL][1:-1, 1:-1]


def test_each_step_gives_a_frame_of_one_even_size_and_is_counted(
    playback: Playback, short_drive: Episode
) -> None:
    done: list[int] = []
    frames = drawn(playback, first(short_drive, 4), on_frame=done.append)
    assert done == [1, 2, 3, 4]
    assert {frame.shape for frame in frames} == {(484, 1200, 3)}
    assert not np.array_equal(frames[0], frames[-1])


def test_a_frame_shows_what_the_policy_sees(playback: Playback, short_drive: Episode) -> None:
    frames = drawn(playback, first(short_drive, 3))
    playback.show(2)
    parameters = playback.simulation.car.parameters
    meant = bev_picture.picture(playback.observe().bev, BevConfig(), parameters, scale=2)
    np.testing.assert_array_equal(panel(frames[2], 0), meant[1:-1, 1:-1])


def test_the_landscape_is_asked_for_what_is_seen_and_drawn(
    playback: Playback, short_drive: Episode
) -> None:
    seen: list[Observation] = []

    def landscape(observation: Observation) -> np.ndarray:
        seen.append(observation)
        peaked = np.full((9, 9), 1e-9)
        peaked[4, 4] = 1.0
        return peaked

    short = first(short_drive, 2)
    with_one, without = drawn(playback, short, landscape=landscape), drawn(playback, short)
    assert [float(it.state[0]) for it in seen] == pytest.approx(short.vehicle[:, 3].tolist())
    colours = {tuple(pixel) for pixel in panel(with_one[0], 1).reshape(-1, 3).tolist()}
    plain = {tuple(pixel) for pixel in panel(without[0], 1).reshape(-1, 3).tolist()}
    assert len(colours) > 5 * len(plain)


def test_an_infraction_is_marked_from_its_time_on(playback: Playback, short_drive: Episode) -> None:
    x, y = short_drive.vehicle[0, :2].tolist()
    breach = Infraction(InfractionKind.COLLISION, 0.2, x, y, "pole")
    short = first(short_drive, 4)
    marked = drawn(playback, dataclasses.replace(short, infractions=(breach,)))
    clean = drawn(playback, short)
    differs = [not np.array_equal(panel(a, 2), panel(b, 2)) for a, b in zip(marked, clean, strict=True)]  # fmt: skip
    assert differs == [False, False, True, True]


def test_three_cameras_are_seen_above_the_rest(short_drive: Episode) -> None:
    playback = Playback(first(short_drive, 1))
    (frame,) = film.frames(playback)
    assert frame.shape == (484 + 216 + LABEL, 1200, 3)
    views = [frame[TOP + 1 : TOP + 215, GAP + i * (PANEL + GAP) + 1 :][:, : PANEL - 2] for i in range(3)]  # fmt: skip
    for view in views:
        assert view[:20].mean(axis=(0, 1)).argmax() == 2 or view.std() > 20  # sky, or a house
        assert len(np.unique(view.reshape(-1, 3), axis=0)) > 100


def test_cameras_without_opengl_are_refused_with_what_to_install(
    playback: Playback, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MUJOCO_GL", "off")
    with pytest.raises(RenderError, match="MUJOCO_GL"):
        next(film.frames(playback))
