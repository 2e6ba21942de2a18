import dataclasses

import numpy as np
import pytest

from mjdrive.config import TuneConfig
from mjdrive.datatypes import Infraction, InfractionKind
from mjdrive.errors import ConfigError
from mjdrive.tuning.marks import judge

CONFIG = TuneConfig()


def with_infraction(trace, kind):
    there = Infraction(kind, 1.0, 0.0, 0.0, "thing")
    return trace._replace(episode=dataclasses.replace(trace.episode, infractions=(there,)))


def test_cost_is_the_sum_of_the_marks_over_their_scales(traces02):
    marks = judge(traces02, CONFIG)
    parts = (
        marks.offset_rms_m / CONFIG.offset_scale,
        marks.steering_whiteness / CONFIG.whiteness_scale,
        marks.jerk_rms / CONFIG.jerk_scale,
        marks.slowness / CONFIG.slowness_scale,
    )
    assert marks.mishaps == 0
    assert marks.cost == pytest.approx(sum(parts), abs=2e-3)


def test_a_mark_weighs_less_on_a_larger_scale(traces02):
    lenient = dataclasses.replace(CONFIG, offset_scale=10 * CONFIG.offset_scale)
    saved = judge(traces02, CONFIG).cost - judge(traces02, lenient).cost
    offset = judge(traces02, CONFIG).offset_rms_m
    assert saved == pytest.approx(0.9 * offset / CONFIG.offset_scale, abs=2e-3)


def test_infractions_and_unfinished_exercises_are_mishaps_but_lights_are_not(traces02):
    bend, beside = traces02
    run = (with_infraction(bend, InfractionKind.RED_LIGHT), beside)
    hit = (with_infraction(bend, InfractionKind.COLLISION), beside)
    late = (bend._replace(is_finished=False), beside)
    assert [judge(traces, CONFIG).mishaps for traces in (run, hit, late)] == [0, 1, 1]
    assert judge(hit, CONFIG).cost - judge(run, CONFIG).cost == pytest.approx(CONFIG.mishap_cost)


def test_largest_offset_leaves_out_the_start_beside_the_lane(traces02):
    bend, _ = traces02
    marks = judge(traces02, CONFIG)
    assert marks.offset_max_m == pytest.approx(np.abs(bend.offsets).max(), abs=1e-4)


@pytest.mark.parametrize(
    "wrong",
    [{"trials": 1}, {"bends": 0}, {"spread": 0.0}, {"jerk_scale": -1.0}, {"mishap_cost": -1.0}],
)
def test_settings_that_cannot_be_are_refused(wrong):
    with pytest.raises(ConfigError, match=next(iter(wrong))):
        TuneConfig(**wrong)
