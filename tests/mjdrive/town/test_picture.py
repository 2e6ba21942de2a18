from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mjdrive.datatypes import Town
from mjdrive.town import picture
from mjdrive.town.picture import Sheet


def shown_at(town: Town, image: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Colours of a pixel and its eight neighbours, shape (9, 3)."""
    column, row = np.rint(Sheet(town).pixels(point[None])[0]).astype(int)
    return image[row - 1 : row + 2, column - 1 : column + 2].reshape(-1, 3).astype(int)


def nearest(colours: np.ndarray, wanted: tuple[int, int, int]) -> int:
    return int(np.abs(colours - wanted).max(axis=1).min())


def test_every_lane_has_the_colour_of_its_move_and_every_light_a_stop_line(ladder: Town) -> None:
    image = picture.draw(replace(ladder, lights={}))
    for lane in ladder.lanes.values():
        alone = picture.draw(replace(ladder, lanes={lane.id: lane}, lights={}))
        middle = shown_at(ladder, alone, lane.centerline[len(lane.centerline) // 2])
        assert nearest(middle, picture.MOVE_COLOURS[lane.move]) < 60, lane.id
        assert not (shown_at(ladder, image, lane.centerline[0]) == picture.PAPER).all()
    image = picture.draw(ladder)
    for light in ladder.lights.values():
        assert (
            nearest(shown_at(ladder, image, light.stop_line.mean(axis=0)), picture.STOP_LINE) < 60
        )
        assert nearest(shown_at(ladder, image, light.pole), picture.INK) < 60


def test_places_lie_north_up_and_at_one_scale(ladder: Town) -> None:
    sheet = Sheet(ladder)
    origin, east, north = sheet.pixels(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]))
    assert east - origin == pytest.approx([sheet.scale, 0.0])
    assert north - origin == pytest.approx([0.0, -sheet.scale])


def test_names_of_junctions_are_left_out_where_they_would_hide_the_town(ladder: Town) -> None:
    def names_change_it(town: Town) -> bool:
        lights = {
            name: replace(light, junction=f"{light.junction}0000")
            for name, light in town.lights.items()
        }
        lanes = {
            name: lane if lane.junction is None else replace(lane, junction=f"{lane.junction}0000")
            for name, lane in town.lanes.items()
        }
        renamed = replace(town, lights=lights, lanes=lanes)
        return not np.array_equal(picture.draw(town), picture.draw(renamed))

    assert names_change_it(ladder)
    assert not names_change_it(replace(ladder, bounds=np.array([-2000.0, -2000.0, 2000.0, 2000.0])))


def test_the_picture_is_small_and_the_same_every_time(ladder: Town, tmp_path: Path) -> None:
    paths = [tmp_path / "first.png", tmp_path / "second.png"]
    for path in paths:
        picture.save(ladder, path)
    first, second = (path.read_bytes() for path in paths)
    assert first == second
    assert first.startswith(b"\x89PNG")
    assert 10_000 < len(first) < 150_000
