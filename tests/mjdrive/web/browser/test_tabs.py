"""Episodes and runs: lists, replays, figures."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.timeout(900)


def test_an_episode_is_found_by_its_words(bench: Any) -> None:
    bench.page.click("#tab-episodes")
    bench.page.fill("#episodes [type=search]", "searcher drive-1")
    bench.see("document.querySelectorAll('#episodes tbody tr').length === 1")
    assert "drives/drive-1/episode" in bench.page.inner_text("#episodes tbody")
    other = bench.open(bench.page.url.split("?", 1)[1])
    other.wait_for_function(
        "document.querySelectorAll('#episodes tbody tr').length === 1", polling=100
    )
    other.close()
    bench.page.fill("#episodes [type=search]", "nothing is called that")
    bench.page.wait_for_selector("text=No episode has all of these words")
    bench.page.fill("#episodes [type=search]", "")


def test_a_replay_is_scrubbed_and_its_address_leads_to_the_same_moment(bench: Any) -> None:
    bench.page.click("#tab-episodes")
    bench.page.click("text=drives/drive-0/episode")
    bench.see("mjdrive.replay.isOpen")
    bench.page.click("[aria-label^='Go to kerb at 2.0 s']")
    bench.see("document.querySelector('#clock').textContent === '2.0 s'")
    assert bench.page.inner_text("#kmh") == "36"
    bench.page.keyboard.press(".")
    bench.see("document.querySelector('#clock').textContent === '2.1 s'")
    other = bench.open(bench.page.url.split("?", 1)[1])
    other.wait_for_selector("#replay:not([hidden])")
    assert other.inner_text("#clock") == "2.1 s"
    assert "kerb" in other.inner_text("#infractions")
    other.close()
    tick = bench.watcher.panel["tick"]
    bench.wait(lambda: bench.watcher.panel["tick"] > tick, "the live drive to go on")


def test_a_replay_shows_its_own_town_while_another_is_driven_in(bench: Any) -> None:
    bench.page.select_option("#town", "town02")
    bench.watcher.until(town="town02")
    bench.see("mjdrive.live.town === 'town02'")
    assert "town=town02" in bench.page.url
    bench.page.click("#tab-episodes")
    bench.page.click("text=drives/drive-0/episode")
    bench.see("mjdrive.replay.isOpen && mjdrive.live.town === 'town03'")
    bench.page.keyboard.press("Escape")
    bench.see("!mjdrive.replay.isOpen && mjdrive.live.town === 'town02'")
    bench.page.select_option("#town", "town03")
    bench.watcher.until(town="town03")
    bench.see("mjdrive.live.town === 'town03'")


def test_an_episode_is_exported_byte_by_byte(bench: Any, tmp_path: Path) -> None:
    bench.page.click("#tab-episodes")
    with bench.page.expect_download() as download:
        bench.page.click("[aria-label='Export drives/drive-0/episode']")
    assert download.value.suggested_filename == "drives-drive-0-episode.hdf5"
    download.value.save_as(tmp_path / "episode.hdf5")
    original = bench.folder / "drives" / "drive-0" / "episode.hdf5"
    assert (tmp_path / "episode.hdf5").read_bytes() == original.read_bytes()


def test_a_drive_is_deleted_from_the_disk(bench: Any) -> None:
    original = bench.folder / "drives" / "drive-0" / "episode.hdf5"
    copy = bench.folder / "drives" / "unwanted" / "episode.hdf5"
    copy.parent.mkdir()
    copy.write_bytes(original.read_bytes())
    bench.page.click("#tab-episodes")
    bench.page.click("[aria-label='Delete drives/unwanted/episode']")
    bench.wait(lambda: not copy.parent.exists(), "the file to go")
    assert original.exists()


def test_a_damaged_episode_is_listed_with_the_reason(bench: Any) -> None:
    broken = bench.folder / "drives" / "broken.hdf5"
    broken.write_bytes(b"no episode")
    bench.page.click("#tab-episodes")
    bench.page.click("text=1 file cannot be read")
    assert "drives/broken" in bench.page.inner_text("#episodes details")
    broken.unlink()


def test_a_run_that_was_trained_meanwhile_can_be_chosen(bench: Any) -> None:
    run = bench.folder / "runs" / "trained-later"
    listed = (
        "[...document.querySelector('#policy').options].some(it => it.value === 'trained-later')"
    )
    assert not bench.page.evaluate(listed)
    shutil.copytree(run.with_name("searcher"), run)
    bench.page.focus("#policy")
    bench.see(listed)
    shutil.rmtree(run)
    bench.page.click("#tab-runs")
    bench.page.click("#tab-live")
    bench.see(f"!{listed}")


def test_runs_and_drives_are_compared_by_the_figures_on_disk(bench: Any) -> None:
    bench.page.click("#tab-runs")
    bench.page.wait_for_selector("[aria-label^='Loss of da-ibc by epoch: searcher']")
    run = bench.page.inner_text("[aria-label='Training runs'] tbody").split()
    assert run == ["searcher", "da-ibc", "0", "3", "0.333", "0.667", "3"]
    drives = [json.loads(it.read_text()) for it in bench.folder.glob("drives/*/summary.json")]
    kilometres = sum(it["distance_m"] for it in drives) / 1000
    rate = sum(it["red_lights"] for it in drives) / kilometres
    row = bench.page.locator("[aria-label='Evaluation of drives'] tbody td").all_inner_texts()
    assert row[:7] == ["searcher", "town03", "2", "1 of 2", "200 ± 141", "200 ± 141", f"{rate:.2f}"]
    bench.page.uncheck("[aria-label='Show searcher']")
    bench.see("!document.querySelector('#runs canvas')")
    other = bench.open(bench.page.url.split("?", 1)[1])
    other.wait_for_selector("[aria-label='Training runs']")
    assert not other.is_checked("[aria-label='Show searcher']")
    other.close()
    bench.page.check("[aria-label='Show searcher']")
