"""The page as such: what it may load, what it does without WebGL, on small screens, and for those who do not see it."""

from typing import Any
from urllib.parse import parse_qsl, urlsplit

import pytest

pytestmark = pytest.mark.timeout(900)

NAMELESS = """
[...document.querySelectorAll("button, select, input, canvas, [role=radiogroup], dialog[open]")]
  .filter(it => it.checkVisibility())
  .filter(it => !(it.ariaLabel || it.textContent.trim() || it.labels?.length || it.getAttribute("aria-labelledby")))
  .map(it => it.outerHTML)
"""
ANNOUNCED = """
[...document.querySelectorAll("output, [role=status], [role=alert], [aria-live]")]
  .filter(it => it.ariaLive !== "off" && it.checkVisibility()).map(it => it.textContent)
"""
OVERFLOW = "document.documentElement.scrollWidth - document.documentElement.clientWidth"


def test_nothing_is_fetched_from_elsewhere_and_nothing_fails(bench: Any) -> None:
    bench.see("mjdrive.live.panels > 2")
    assert bench.foreign == []
    assert bench.problems == []


def test_the_content_policy_holds_without_complaint(browser: Any, address: str) -> None:
    strict = browser.new_page(viewport={"width": 400, "height": 300})
    complaints: list[str] = []
    strict.on("console", lambda it: it.type == "error" and complaints.append(it.text))
    answer = strict.goto(address + "?noaa&tab=runs")
    strict.wait_for_selector("[aria-label='Training runs']")
    strict.wait_for_selector("#status:has-text('live · page')", state="attached")
    policy = answer.headers["content-security-policy"]
    assert "script-src 'self';" in policy
    assert "default-src 'none'" in policy
    assert complaints == []
    strict.close()


def test_the_content_policy_stops_foreign_code(browser: Any, address: str) -> None:
    strict = browser.new_page(viewport={"width": 400, "height": 300})
    strict.goto(address + "?noaa&tab=runs")
    ran = strict.evaluate(
        """() => { const it = document.createElement("script"); it.textContent = "window.isForeign = true";
                   document.body.append(it); return window.isForeign === true; }"""
    )
    assert not ran
    strict.close()


def test_without_webgl_the_panels_still_work(bench: Any) -> None:
    plain = bench.open(width=900, height=700)
    plain.wait_for_function("mjdrive.live.panels > 1", polling=100)
    assert plain.locator("#no-gl").is_visible()
    assert plain.locator("#bev").bounding_box()["height"] > 100
    assert "tick" in plain.inner_text("#bev-tick")
    plain.close()


def test_the_address_holds_what_is_shown_and_no_token(bench: Any) -> None:
    other = bench.open("token=secret&policy=mpc&camera=top")
    state = bench.watcher.state
    shown = {key: str(state[key]) for key in ("town", "policy", "seed")}
    query = dict(parse_qsl(urlsplit(other.url).query))
    assert query == {**shown, "camera": "top"}  # it watches, so its address cannot choose
    other.close()


def test_arrow_keys_go_through_the_tabs(bench: Any) -> None:
    page = bench.page
    page.focus("#tab-live")
    for key, tab in (("ArrowRight", "Episodes"), ("End", "Runs"), ("ArrowRight", "Live")):
        page.keyboard.press(key)
        assert page.evaluate("document.activeElement.textContent") == tab
        assert page.is_visible(f"#{tab.lower()}")
    stops = "[...document.querySelectorAll('[role=tab], [role=radio]')].filter(it => it.tabIndex === 0).length"
    assert page.evaluate(stops) == 2  # one of the tabs, one of the cameras


def test_nothing_is_announced_again_and_again_while_somebody_drives(bench: Any) -> None:
    bench.take_the_wheel()
    bench.see("document.querySelector('#recorded').textContent.includes('1 s')")
    before = bench.page.evaluate(ANNOUNCED)
    assert any("You drive" in it for it in before)
    bench.see("document.querySelector('#recorded').textContent.includes('3 s')")
    assert bench.page.evaluate(ANNOUNCED) == before


def test_keys_open_the_help(bench: Any) -> None:
    bench.page.keyboard.press("?")
    assert bench.page.locator("#help").is_visible()
    assert "take the wheel" in bench.page.inner_text("#help")
    bench.page.keyboard.press("Escape")
    assert not bench.page.locator("#help").is_visible()


@pytest.mark.parametrize("tab", ["live", "episodes", "runs"])
def test_everything_has_a_name_and_fits_on_small_screens(bench: Any, tab: str) -> None:
    page = bench.open(f"tab={tab}", width=1100, height=700)
    if tab != "live":
        page.wait_for_selector(f"#{tab} table")
    assert page.evaluate(NAMELESS) == []
    for width in (1100, 800):
        page.set_viewport_size({"width": width, "height": 700})
        assert page.evaluate(OVERFLOW) <= 0, f"{width} px"
    page.close()
