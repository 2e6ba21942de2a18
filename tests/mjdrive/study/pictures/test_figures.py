"""Every figure has ink where it should, and the same bytes for the same input."""

from collections.abc import Callable
from pathlib import Path

import cv2
import matplotlib.colors
import numpy as np
import pytest
from matplotlib.figure import Figure

from mjdrive.datatypes import Town
from mjdrive.evaluation.bootstrap import Interval
from mjdrive.evaluation.landscape import DEEPEST, energies
from mjdrive.study.pictures import figures_ablation, figures_choices, figures_fans, figures_paths
from mjdrive.study.pictures.figure_looks import COLOURS, Look, looks, main_arms
from mjdrive.study.pictures.figures_ablation import AblationRow
from mjdrive.study.pictures.figures_landscape import draw_landscapes, draw_panel
from mjdrive.study.pictures.figures_progress import seeds_in_words
from mjdrive.study.records.fans import FanPath, FanRecord
from mjdrive.study.records.measures import Curve
from mjdrive.study.records.results import DrivenPath, ProgressPoint
from mjdrive.study.records.situations import situations
from mjdrive.study.settings.presets import standard
from models.config import METHODS

Draw = Callable[[Path], None]

TWO_WAYS = np.full((32, 32), 1e-9)
TWO_WAYS[16, 24], TWO_WAYS[16, 6] = 0.65, 0.35
"""65 % left, 35 % right."""


def colours_in(path: Path) -> set[tuple[int, ...]]:
    image = cv2.imread(str(path))[..., ::-1]
    return {tuple(colour) for colour in np.unique(image.reshape(-1, 3), axis=0).tolist()}


def rgb(colour: str) -> tuple[int, ...]:
    return tuple(round(255 * part) for part in matplotlib.colors.to_rgb(colour))


def driven(arm: str, **changes: object) -> DrivenPath:
    points = tuple((float(x), -109.0) for x in range(20, 120, 3))
    fields = {"duration_s": 20.0, "points": points, "red_lights": (), "mishaps": ()}
    return DrivenPath(arm=arm, seed=0, town="town02", **{**fields, **changes})  # type: ignore[arg-type]


def fan(town: Town, move: str) -> FanRecord:
    approach = situations(town)[0].approach
    exits = town.lanes[approach].successors
    taken = next(name for name in exits if town.lanes[name].move.name.lower() == move)
    points = tuple((x, y) for x, y in town.lanes[taken].centerline.tolist())
    return FanRecord("arm", 0, "town02", approach, exits, (FanPath(taken, True, points),) * 3)


@pytest.fixture(params=["landscapes", "paths", "fans", "turns", "ablation"])
def draw(request: pytest.FixtureRequest, town02: Town) -> Draw:
    def landscapes(path: Path) -> None:
        view = np.full((24, 24, 3), 200, np.uint8)
        draw_landscapes(["fork"], [view], {"DA-IBC": [(TWO_WAYS, np.zeros((2, 2)))]}, path)

    def paths(path: Path) -> None:
        figures_paths.draw_paths([(Look("DA-IBC", "#0969da"), driven("a"))], town02, path)

    def fans(path: Path) -> None:
        figures_fans.draw_fans([("DA-IBC", fan(town02, "left"))], town02, path)

    def turns(path: Path) -> None:
        figures_choices.draw_turns({"expert": {"left": 0.4, "right": 0.6}}, path)

    def ablation(path: Path) -> None:
        row = AblationRow("DA-IBC", "#0969da", (Interval(0.5, 0.4, 0.6), None))
        figures_ablation.draw_ablation(["penalty", "recall"], [[row]], path)

    drawers = {"landscapes": landscapes, "paths": paths, "fans": fans, "turns": turns}
    return {**drawers, "ablation": ablation}[request.param]


def test_the_same_input_gives_the_same_bytes(draw: Draw, tmp_path: Path) -> None:
    for name in ("a.png", "b.png"):
        draw(tmp_path / name)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_values_of_the_expert_go_through_all_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[Figure] = []
    monkeypatch.setattr(figures_ablation, "save", lambda figure, path: drawn.append(figure))
    row = AblationRow("DA-IBC", "#0969da", (Interval(0.5, 0.4, 0.6), None))
    expert = AblationRow("expert", "#1f2328", (Interval(0.8, 0.7, 0.9), Interval(0.2, 0.1, 0.3)))
    for reference in (None, expert):
        figures_ablation.draw_ablation(["penalty", "recall"], [[row]] * 2, Path(), reference)
    without, beside = ([list(axes.lines) for axes in figure.axes] for figure in drawn)
    ends = [
        [line.get_xdata()[0] for line in lines if len(line.get_xdata()) == 2] for lines in beside
    ]
    assert ends == [[0.8], [0.2]]
    assert [len(lines) for lines in without] == [2, 0], "a dot for each row that has a figure"
    labels = [text.get_text() for text in drawn[1].axes[0].get_yticklabels()]
    assert labels == ["DA-IBC", "DA-IBC", "expert"]


def test_every_method_has_a_colour_of_its_own() -> None:
    assert set(METHODS) <= COLOURS.keys()
    assert len(set(COLOURS.values())) == len(COLOURS)


def test_ways_to_act_of_one_method_share_its_colour_and_differ_in_their_lines() -> None:
    config = standard()
    found = looks(config)
    methods = {it.name: it.method for it in config.variants}
    arms = [it for it in config.arms if methods[it.variant] == "bc-beta"]
    assert {found[it.name].colour for it in arms} == {COLOURS["bc-beta"]}
    assert len({str(found[it.name].line_style) for it in arms}) == len(arms)


def test_main_arms_are_the_first_of_each_variant_without_ablations() -> None:
    config = standard()
    mains = main_arms(config)
    own = [it.name for it in config.variants if not it.change]
    variants = {it.name: it.variant for it in config.arms}
    assert [variants[name] for name in mains] == sorted(
        own, key=[it.variant for it in config.arms].index
    )


def test_the_likeliest_action_has_energy_zero_and_the_rest_what_it_is_less_likely() -> None:
    probabilities = np.array([[0.5, 0.25], [0.25, 0.0]])
    expected = np.array([[0.0, np.log(2)], [np.log(2), DEEPEST]])
    np.testing.assert_allclose(energies(probabilities), expected)


def test_a_landscape_has_left_on_the_left_and_says_what_its_ways_weigh() -> None:
    axes = Figure().add_subplot()
    draw_panel(axes, (TWO_WAYS, np.zeros((1, 2))))
    left, right = axes.get_xlim()
    assert left > 0 > right
    assert [text.get_text() for text in axes.texts] == ["65 %", "35 %"]


@pytest.mark.parametrize("move", ["left", "right"])
def test_a_fan_has_the_colour_of_the_exit(town02: Town, tmp_path: Path, move: str) -> None:
    axes = Figure().add_subplot()
    figures_fans.draw_fan(axes, fan(town02, move), town02)
    lines = axes.collections[-3:]
    drawn = {matplotlib.colors.to_hex(line.get_color()[0][:3]) for line in lines}
    assert drawn == {figures_choices.MOVES[move]}


def test_infractions_are_pinned_to_the_map(town02: Town, tmp_path: Path) -> None:
    look = Look("DA-IBC", "#0969da")
    figures_paths.draw_paths([(look, driven("a"))], town02, tmp_path / "clean.png")
    bad = driven("a", red_lights=((60.0, -150.0),), mishaps=((100.0, -150.0),))
    figures_paths.draw_paths([(look, bad)], town02, tmp_path / "bad.png")
    pins = {rgb(colour) for _, _, colour in figures_paths.PINS.values()}
    assert pins <= colours_in(tmp_path / "bad.png")
    assert not pins & colours_in(tmp_path / "clean.png")


def test_a_street_driven_more_often_is_darker(town02: Town, tmp_path: Path) -> None:
    once, again = driven("a"), driven("a", points=driven("a").points * 4)
    darkest = []
    for name, path in (("once", once), ("again", again)):
        file = tmp_path / f"{name}.png"
        figures_paths.draw_paths([(Look("x", "#ff0000"), path)], town02, file)
        image = cv2.imread(str(file)).astype(int)  # blue first
        reds = image[(image[..., 2] - image[..., 0] > 40)]
        darkest.append(reds[:, 0].min())
    assert darkest[1] < darkest[0]


def test_a_curve_in_steps_is_read_at_any_place() -> None:
    curve = Curve((0.0, 1.0, 3.0), (0.0, 0.5, 1.0))
    places = np.array([-1.0, 0.0, 0.9, 1.0, 2.9, 3.0, 9.0])
    np.testing.assert_array_equal(figures_choices.at(curve, places), [0, 0, 0, 0.5, 0.5, 1, 1])


def test_progress_says_how_many_seeds_each_point_has_where_they_differ() -> None:
    named = {"a": Look("BC-Beta", "#d1570a"), "b": Look("DA-IBC", "#0969da")}

    def points(*missing: tuple[str, int, int]) -> list[ProgressPoint]:
        every = ((arm, seed, epoch) for arm in "ab" for seed in (0, 1, 2) for epoch in (1, 2, 3))
        return [
            ProgressPoint(it[0], "", it[1], it[2], 0.0, ()) for it in every if it not in missing
        ]

    assert seeds_in_words(points(), named) == ""
    assert seeds_in_words(points(("a", 2, 1), ("a", 2, 2)), named) == (
        "Training seeds of each point: BC-Beta 2 at epoch 1, 2 and 3 at epoch 3; DA-IBC 3."
    )
    assert seeds_in_words([it for it in points() if it.arm == "b" or it.seed], named) == (
        "Training seeds of each point: BC-Beta 2; DA-IBC 3."
    )
