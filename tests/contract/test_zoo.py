"""What every shipped policy keeps: it is what its card says, and it drives as its card says."""

import shlex
from pathlib import Path

import pytest
from hatchling.builders.wheel import WheelBuilder

from mjdrive.cli.collect import collect
from mjdrive.cli.train import train
from mjdrive.config import read_json
from mjdrive.episodes import store
from mjdrive.learning import runs
from mjdrive.learning.settings import learner_settings
from mjdrive.learning.training import Source
from mjdrive.simulation.simulation import Simulation
from mjdrive.zoo import entries
from mjdrive.zoo.cards import read_card
from mjdrive.zoo.page import to_page
from mjdrive.zoo.reference import TOLERANCE, TOWN, drive_reference, rounds_alike
from mjdrive.zoo.shipping import LOSSLESS_ENOUGH, MOST_BYTES, size_of
from mjdrive.zoo.training_command import in_use
from models import checkpoint

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(params=entries.names())
def entry(request: pytest.FixtureRequest) -> Path:
    return entries.FOLDER / request.param


def test_the_policy_that_drives_by_default_is_there() -> None:
    assert entries.DEFAULT in entries.names()


def test_all_of_them_are_small_and_in_the_wheel() -> None:
    assert size_of(entries.FOLDER) <= MOST_BYTES
    held = {file.distribution_path for file in WheelBuilder(str(ROOT)).recurse_included_files()}
    shipped = {path for path in entries.FOLDER.rglob("*") if path.is_file()}
    assert {str(path.relative_to(ROOT)) for path in shipped} <= held


def test_weights_and_source_are_those_of_the_card(entry: Path) -> None:
    card = read_card(entry)
    assert store.digest((entry / checkpoint.MODEL).read_bytes()) == card.weights.sha256
    assert read_json(Source, entry / runs.SOURCE) == card.source
    state = checkpoint.load_state(entry)
    assert (state.method, state.seed) == (card.method, card.training.seed)
    assert (state.epoch, state.epochs) == (len(card.training.losses), card.training.epochs)
    assert card.weights.largest_variation <= LOSSLESS_ENOUGH


def test_the_page_is_the_card(entry: Path) -> None:
    assert (entry / entries.PAGE).read_text() == to_page(read_card(entry))


def test_the_commands_of_the_card_make_its_settings(entry: Path) -> None:
    *collects, trained = map(shlex.split, read_card(entry).training.commands)
    folders = []
    for words in collects:
        assert words[:2] == ["mjdrive", "collect"]
        given = collect.make_context("collect", words[2:]).params
        folders.append(given["out"] or Path("data", given["town_name"]))
    given = train.make_context("train", trained[2:]).params
    found = learner_settings(
        given["method"], preset=given["preset"], assignments=given["assignments"]
    )
    hint = "the presets have changed: python scripts/refresh_cards.py"
    assert in_use(found) == in_use(checkpoint.load_config(entry)), hint
    assert given["seed"] == read_card(entry).training.seed
    assert given["data"] == folders[-1]


def test_it_drives_as_its_card_says(entry: Path, simulation: Simulation) -> None:
    card = read_card(entry).reference
    assert card.town == simulation.town.name == TOWN
    again = drive_reference(entry, simulation, seed=card.seed, num_steps=card.steps)
    if rounds_alike(again, card):
        assert again == card
    assert again.distance_m == pytest.approx(card.distance_m, abs=TOLERANCE)
    assert (again.end_x, again.end_y) == pytest.approx((card.end_x, card.end_y), abs=TOLERANCE)
