"""What a study collects."""

from pathlib import Path

from mjdrive.config import StudyConfig
from mjdrive.study.jobs.collecting import collections
from mjdrive.study.records.folder import HELD_OUT, StudyFolder


def test_the_expert_is_disturbed_where_agents_learn_and_not_where_they_are_judged(
    tiny: StudyConfig, tmp_path: Path
) -> None:
    learnt, held_out = collections(tiny, StudyFolder(tmp_path), given={})
    assert learnt.settings.disturbance is not None
    assert (held_out.folder.name, held_out.settings.disturbance) == (HELD_OUT, None)
