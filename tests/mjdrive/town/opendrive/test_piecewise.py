import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.town.opendrive.piecewise import SAME_PLACE, Piecewise

PLACES = st.lists(st.floats(-100.0, 100.0), min_size=1, max_size=9).map(sorted)


@given(functions=st.lists(PLACES, min_size=1, max_size=5), s=st.lists(st.floats(-120.0, 120.0)))
def test_the_piece_found_is_the_last_that_starts_before_a_place(
    functions: list[list[float]], s: list[float]
) -> None:
    table = Piecewise(
        [[(start, float(number)) for start in starts] for number, starts in enumerate(functions)]
    )
    before = 0
    for number, starts in enumerate(functions):
        places = np.array([*s, *starts])
        found = table.find(np.full(len(places), number), places)
        expected = np.searchsorted(starts, places + SAME_PLACE, side="right") - 1
        np.testing.assert_array_equal(found - before, np.maximum(expected, 0))
        np.testing.assert_array_equal(table.numbers(found)[1], number)
        before += len(starts)
