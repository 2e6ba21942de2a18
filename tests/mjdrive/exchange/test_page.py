"""The page by its content; tests/mjdrive/web/browser/test_exported_page.py opens it."""

import base64
import html
import json
import re
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mjdrive.bev.layers import unpack
from mjdrive.datatypes import Infraction
from mjdrive.exchange.html.page import EpisodePage
from mjdrive.exchange.sources import Recording
from mjdrive.exchange.views import ViewMaker
from mjdrive.recording.playback import town_of
from mjdrive.town import signals


@pytest.fixture(scope="module")
def text(exported: Callable[[str], Path]) -> str:
    return (exported("html") / "bad.html").read_text()


@pytest.fixture(scope="module")
def data(text: str) -> dict[str, Any]:
    (found,) = re.findall(r'<script type="application/json" id="episode">(.*?)</script>', text)
    return json.loads(found)


def test_the_page_asks_for_nothing_outside_itself(text: str) -> None:
    assert not re.findall(r"""(?:src|href)\s*=|https?:|url\(|@import|\bimport\b|fetch\(""", text)
    assert "default-src 'none'" in text


def test_every_view_is_that_of_the_policy(
    data: dict[str, Any], recordings: list[Recording]
) -> None:
    episode = recordings[0].episode
    views = ViewMaker(town_of(episode))
    assert len(data["views"]) == len(episode.time)
    for step in (0, 7, 14):
        codes = zlib.decompress(base64.b64decode(data["views"][step]))
        seen = unpack(np.frombuffer(codes, np.uint8).reshape(192, 192))
        np.testing.assert_array_equal(seen, views.bev(episode, step))


def test_path_speed_and_actions_are_those_of_the_drive(
    data: dict[str, Any], recordings: list[Recording]
) -> None:
    episode = recordings[0].episode
    np.testing.assert_allclose(data["path"], episode.vehicle[:, :3], atol=1e-3)
    np.testing.assert_allclose(data["speed"], episode.vehicle[:, 3], atol=1e-3)
    np.testing.assert_allclose(data["actions"], episode.actions, atol=1e-4)


def test_lights_show_at_each_step_what_they_showed(
    data: dict[str, Any], recordings: list[Recording]
) -> None:
    episode = recordings[0].episode
    lights = town_of(episode).lights.values()
    for drawn, light in zip(data["town"]["lights"], lights, strict=True):
        for step, time in enumerate(episode.time.tolist()):
            (*_, (_, shown)) = (it for it in drawn["shows"] if it[0] <= step)
            assert shown == signals.at(light, time + episode.light_phase)


def test_names_out_of_a_town_cannot_become_markup(
    data: dict[str, Any], text: str, breach: Infraction
) -> None:
    assert data["infractions"][0]["cause"] == breach.cause
    assert breach.cause not in text
    assert text.count("</script>") == 2


def test_a_notebook_shows_the_page_in_a_frame_of_its_own(recordings: list[Recording]) -> None:
    page = EpisodePage(recordings[1].episode)
    shown = page._repr_html_()
    (inner,) = re.findall(r'srcdoc="([^"]*)"', shown)
    assert html.unescape(inner) == page.text
    assert 'sandbox="allow-scripts"' in shown


def test_the_same_drive_gives_the_same_page(recordings: list[Recording], text: str) -> None:
    assert EpisodePage(recordings[0].episode).text == text
