from pathlib import Path

from matplotlib.figure import Figure

from mjdrive.datatypes import Town
from mjdrive.town import picture


def test_every_lane_light_and_junction_is_drawn(ladder: Town) -> None:
    axes = Figure().subplots()
    picture.draw(ladder, axes)
    outlines, centres, stop_lines = axes.collections
    assert len(outlines.get_paths()) == len(centres.get_paths()) == len(ladder.lanes)
    assert len(stop_lines.get_paths()) == len(ladder.lights)
    (poles,) = axes.lines
    assert len(poles.get_xdata()) == len(ladder.lights)
    assert {text.get_text() for text in axes.texts} == {"20", "21"}


def test_the_picture_is_small_and_the_same_every_time(ladder: Town, tmp_path: Path) -> None:
    paths = [tmp_path / "first.png", tmp_path / "second.png"]
    for path in paths:
        picture.save(ladder, path)
    first, second = (path.read_bytes() for path in paths)
    assert first == second
    assert first.startswith(b"\x89PNG")
    assert 10_000 < len(first) < 150_000
