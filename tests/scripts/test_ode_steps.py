from collections.abc import Callable
from types import ModuleType

import pytest
from click.testing import CliRunner

from models.ode_density import noise_ratios


def test_more_steps_come_closer_and_the_spacing_of_the_models_is_the_better_one(
    load_script: Callable[[str], ModuleType],
) -> None:
    script = load_script("ode_steps")
    few, many = (script.error(noise_ratios(0.05, script.CEILING, count)) for count in (6, 12))
    assert many < 0.1 * few
    assert many < 0.2 * script.error(script.evenly(0.05, 12))


def test_a_column_for_each_spacing(load_script: Callable[[str], ModuleType]) -> None:
    done = CliRunner().invoke(load_script("ode_steps").main, ["--steps", "8"])
    assert done.exit_code == 0, done.output
    *_, row = done.output.splitlines()
    number, *errors = row.strip("| ").split(" | ")
    assert number == "8"
    assert [float(it) for it in errors] == [pytest.approx(0.1, abs=0.1)] * 3
