"""The page by its content; tests/mjdrive/web/browser/test_exported_page.py opens it."""

import base64
import dataclasses
import html
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mjdrive.datatypes import Episode, Infraction
from mjdrive.errors import DataError
from mjdrive.exchange.html.page import EpisodePage
from mjdrive.exchange.sources import Recording
from mjdrive.exchange.views import ViewMaker
from mjdrive.page import built, wire
from mjdrive.page.replaying import episode_message
from mjdrive.page.scene import scene_message
from mjdrive.recording.playback import town_of
from mjdrive.simulation.simulation import Simulation
from mjdrive.vehicle import cars


@pytest.fixture(scope="module")
def text(exported: Callable[[str], Path]) -> str:
    return (exported("html") / "bad.html").read_text()


@pytest.fixture(scope="module")
def data(text: str) -> dict[str, Any]:
    (found,) = re.findall(r'<script type="application/json" id="drive">(.*?)</script>', text)
    return json.loads(found)


def told(text: str) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    return wire.unpack(base64.b64decode(text))


def test_it_is_the_live_page_and_asks_for_nothing_outside_itself(text: str) -> None:
    for name in ("page.js", "page.css"):
        assert (built.FOLDER / name).read_text() in text
    document = text.replace((built.FOLDER / "page.js").read_text(), "")
    assert not re.findall(r"""src\s*=|https?:|url\(|@import|href="(?!data:)""", document)
    assert "default-src 'none'" in text


def test_every_view_is_that_of_the_policy(
    data: dict[str, Any], recordings: list[Recording]
) -> None:
    episode = recordings[0].episode
    views = ViewMaker(town_of(episode))
    assert len(data["views"]) == len(episode.time)
    for step in (0, 7, 14):
        _, blobs = told(data["views"][step])
        np.testing.assert_array_equal(blobs["bev"], views.bev(episode, step))


def test_the_drive_is_what_a_server_would_tell_of_it(
    data: dict[str, Any], recordings: list[Recording]
) -> None:
    episode = recordings[0].episode
    head, blobs = told(data["episode"])
    meant_head, meant = wire.unpack(episode_message(episode, data["title"]))
    assert head == meant_head
    assert blobs.keys() == meant.keys()
    for name, array in meant.items():
        np.testing.assert_array_equal(blobs[name], array)


def test_the_town_is_what_a_server_would_tell_of_it(
    data: dict[str, Any], recordings: list[Recording]
) -> None:
    town = town_of(recordings[0].episode)
    head, blobs = told(data["scene"])
    meant_head, meant = wire.unpack(scene_message(town, Simulation(town).model))
    assert head == meant_head
    assert all(np.array_equal(blobs[name], array) for name, array in meant.items())


def test_names_out_of_a_town_cannot_become_markup(
    data: dict[str, Any], text: str, breach: Infraction
) -> None:
    head, _ = told(data["episode"])
    assert head["infractions"][0][-1] == breach.cause
    assert breach.cause not in text
    assert text.count("</script>") == 2


def test_another_car_is_drawn_as_it_is(short_drive: Episode, tmp_path: Path) -> None:
    own = tmp_path / "own.xml"
    own.write_text(cars.load("mkz").path.read_text())
    mkz = Simulation(town_of(short_drive), car=cars.load("mkz"))
    mkz.reset(lane=next(iter(mkz.town.lanes)), station=5.0, seed=0)
    physics = np.stack([mkz.car.save()] * len(short_drive.time))
    metadata = {**short_drive.metadata, "car": "own", "car_digest": cars.load(str(own)).digest}
    episode = dataclasses.replace(short_drive, physics=physics, metadata=metadata)
    with pytest.raises(DataError, match="--car"):
        EpisodePage(episode)
    (found,) = re.findall(
        r'id="drive">(.*?)</script>', EpisodePage(episode, car=str(own)).text, flags=re.DOTALL
    )
    shown = json.loads(found)
    scene, _ = told(shown["scene"])
    width, nose, tail = scene["footprint"]
    car = mkz.car.parameters
    assert (width / 5, (nose - tail) / 5) == pytest.approx((car.width, car.length), abs=0.01)
    _, blobs = told(shown["episode"])
    assert blobs["poses"].shape == (len(episode.time), scene["bodies"], 7)
    np.testing.assert_allclose(blobs["poses"][0, 0, :3], mkz.data.xpos[1], atol=1e-3)


def test_a_notebook_shows_the_page_in_a_frame_of_its_own(recordings: list[Recording]) -> None:
    page = EpisodePage(recordings[1].episode)
    shown = page._repr_html_()
    (inner,) = re.findall(r'srcdoc="([^"]*)"', shown)
    assert html.unescape(inner) == page.text
    assert 'sandbox="allow-scripts"' in shown


def test_the_same_drive_gives_the_same_page(recordings: list[Recording], text: str) -> None:
    assert EpisodePage(recordings[0].episode).text == text
