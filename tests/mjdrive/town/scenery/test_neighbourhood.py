import shapely
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.town.scenery.neighbourhood import Neighbourhood

SIDES = st.floats(0.1, 20.0)
BOXES = st.builds(
    lambda x, y, width, height: (x, y, x + width, y + height),
    st.floats(-50.0, 50.0),
    st.floats(-50.0, 50.0),
    SIDES,
    SIDES,
)


@given(boxes=st.lists(BOXES, max_size=12), here=BOXES, cell=st.floats(1.0, 30.0))
def test_all_that_touches_is_near_and_comes_once_and_in_order(
    boxes: list[tuple[float, float, float, float]],
    here: tuple[float, float, float, float],
    cell: float,
) -> None:
    neighbourhood = Neighbourhood[int](cell)
    for number, box in enumerate(boxes):
        neighbourhood.add(number, box)
    near = neighbourhood.near(here)
    assert near == sorted(set(near))
    touching = {
        number
        for number, box in enumerate(boxes)
        if shapely.intersects(shapely.box(*box), shapely.box(*here))
    }
    assert touching <= set(near)


def test_what_has_to_be_looked_at_does_not_grow_with_the_town() -> None:
    looked_at = []
    for length in (10, 100):
        row = Neighbourhood[int](cell=20.0)
        for number in range(length):
            row.add(number, (15.0 * number, 0.0, 15.0 * number + 12.0, 10.0))
        looked_at.append(
            max(len(row.near((15.0 * n, 0.0, 15.0 * n + 12.0, 10.0))) for n in range(length))
        )
    assert looked_at[0] == looked_at[1] <= 4
