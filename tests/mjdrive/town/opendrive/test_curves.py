import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pyclothoids import Clothoid

from mjdrive.town.opendrive.curves import curve, curve_length
from mjdrive.town.opendrive.road_shapes import Arc, Line, ParamPoly3, Poly3, Shape, Spiral

curvatures = st.floats(-0.3, 0.3)

SHAPES: list[Shape] = [
    Line(),
    Arc(-0.1),
    Spiral(0.0, 0.2),
    Spiral(-0.1, 0.15),
    Poly3(0.5, -0.3, 0.02, -0.001),
    ParamPoly3((0.0, 25.0, 10.0, -8.0), (0.0, 0.0, 30.0, -12.0), is_normalized=True),
]


@given(start=curvatures, end=curvatures, length=st.floats(0.1, 200.0))
def test_a_spiral_agrees_with_another_implementation(
    start: float, end: float, length: float
) -> None:
    other = Clothoid.StandardParams(0.0, 0.0, 0.0, start, (end - start) / length, length)
    s = np.linspace(0.0, length, 20)
    u, v, heading = curve(Spiral(start, end), length, s)
    np.testing.assert_allclose(u, [other.X(x) for x in s], atol=1e-7)
    np.testing.assert_allclose(v, [other.Y(x) for x in s], atol=1e-7)
    np.testing.assert_allclose(heading, [other.Theta(x) for x in s], atol=1e-9)


@given(curvature=curvatures, change=st.floats(-1e-9, 1e-9), length=st.floats(0.1, 200.0))
def test_a_spiral_that_hardly_changes_is_an_arc(
    curvature: float, change: float, length: float
) -> None:
    s = np.linspace(0.0, length, 20)
    spiral = curve(Spiral(curvature, curvature + change), length, s)
    np.testing.assert_allclose(spiral, curve(Arc(curvature), length, s), atol=1e-4)


def test_a_spiral_may_wind_up_many_times() -> None:
    length, end = 100.0, 10.0
    u, v, _ = curve(Spiral(0.0, end), length, np.array([length]))
    # Far out an Euler spiral is close to its centre, sqrt(pi / (4 rate)) in both directions: it circles there.
    centre = np.sqrt(np.pi / (4.0 * end / length))
    assert np.hypot(u[0] - centre, v[0] - centre) == pytest.approx(1.0 / end, rel=1e-3)


@pytest.mark.parametrize("shape", SHAPES)
def test_headings_are_tangents_and_s_is_arc_length(shape: Shape) -> None:
    length = curve_length(shape, 30.0) if isinstance(shape, ParamPoly3) else 30.0
    s = np.linspace(0.1, length - 0.1, 100)
    step = 1e-4
    before, after = (curve(shape, length, s + ds) for ds in (-step, step))
    forward = [(after[axis] - before[axis]) / (2.0 * step) for axis in (0, 1)]
    _, _, heading = curve(shape, length, s)
    np.testing.assert_allclose(forward, [np.cos(heading), np.sin(heading)], atol=1e-6)


@given(steepness=st.floats(0.001, 1e3))
def test_a_parabola_has_the_arc_length_of_the_textbook(steepness: float) -> None:
    u = np.linspace(0.0, 20.0, 30)
    w = 2.0 * steepness * u
    s = (w * np.hypot(1.0, w) + np.arcsinh(w)) / (4.0 * steepness)
    found_u, found_v, _ = curve(Poly3(0.0, 0.0, steepness, 0.0), float(s[-1]), s)
    np.testing.assert_allclose(found_u, u, atol=1e-5)
    np.testing.assert_allclose(found_v, steepness * found_u**2, rtol=1e-12)


def test_a_graph_that_rises_at_once_stays_at_its_start() -> None:
    u, v, _ = curve(Poly3(1.0, 1e6, 0.0, 0.0), 10.0, np.array([0.0, 5.0, 10.0]))
    np.testing.assert_allclose(u, [0.0, 5e-6, 1e-5], rtol=1e-6)
    np.testing.assert_allclose(v, [1.0, 6.0, 11.0], rtol=1e-6)


def test_both_ranges_of_the_parameter_are_the_same_curve() -> None:
    u, v, length = (0.0, 25.0, 10.0, -8.0), (0.0, 0.0, 30.0, -12.0), 40.0
    by_length = ParamPoly3(
        tuple(c / length**n for n, c in enumerate(u)),  # type: ignore[arg-type]
        tuple(c / length**n for n, c in enumerate(v)),  # type: ignore[arg-type]
        is_normalized=False,
    )
    s = np.linspace(0.0, length, 50)
    np.testing.assert_allclose(
        curve(by_length, length, s), curve(ParamPoly3(u, v, True), length, s), atol=1e-7
    )


def test_an_uneven_parameter_still_runs_by_arc_length() -> None:
    shape = ParamPoly3((0.0, 1.0, 0.0, 9.0), (0.0, 0.0, 0.0, 0.0), is_normalized=True)
    s = np.linspace(0.0, 10.0, 11)
    u, v, heading = curve(shape, 10.0, s)
    np.testing.assert_allclose(u, s, atol=1e-9)
    np.testing.assert_array_equal(v, 0.0)
    np.testing.assert_array_equal(heading, 0.0)


def test_a_rounded_length_still_reaches_the_end_of_the_curve() -> None:
    shape = ParamPoly3((0.0, 10.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0), is_normalized=True)
    u, _, _ = curve(shape, 9.99, np.array([9.99]))
    assert u[0] == pytest.approx(10.0, abs=1e-9)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_curve_goes_on_a_little_beyond_its_end(shape: Shape) -> None:
    length = 30.0
    u, v, heading = curve(shape, length, np.array([length, length + 0.001]))
    step = np.array([u[1] - u[0], v[1] - v[0]])
    np.testing.assert_allclose(
        step, 0.001 * np.array([np.cos(heading[0]), np.sin(heading[0])]), atol=1e-6
    )
