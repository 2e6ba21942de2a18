import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest
import torch

from mjdrive.datatypes import Observation
from mjdrive.errors import ConfigError, RunError
from mjdrive.learning import pilot
from models import checkpoint, hardware, presets
from models.energy_scoring import resolved
from models.interfaces import Learner
from models.learners import build_learner
from models.samplers.commitment import Commitment

SEEN = Observation(bev=np.full((5, 192, 192), 80, np.uint8), state=np.zeros(3, np.float32))


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """An untrained DA-IBC run."""
    folder = tmp_path / "mine"
    learner = build_learner(presets.quick("da-ibc"), seed=0)
    learner.prepare(torch.zeros(4, 2), torch.ones(4))
    checkpoint.save(folder, learner, checkpoint.RunState("da-ibc", 0, 1, 1))
    return folder


def test_pilot_is_named_after_its_folder_and_acts_within_bounds(run: Path) -> None:
    policy = pilot.load(run)
    policy.reset(0)
    action = policy.act(SEEN)
    assert policy.name == "mine"
    assert abs(action.acceleration) <= 1
    assert abs(action.steering) <= 1


def test_same_seed_acts_alike_and_each_reset_starts_over(run: Path) -> None:
    policy = pilot.load(run)
    drives = []
    for seed in (7, 7, 8):
        policy.reset(seed)
        drives.append([policy.act(SEEN) for _ in range(5)])
    assert drives[0] == drives[1]
    assert drives[0] != drives[2]


def held(policy: pilot.Pilot, hold: int) -> None:
    commitment = dataclasses.replace(policy.config.commitment, hold=hold)
    policy.config = dataclasses.replace(policy.config, commitment=commitment)


def test_what_lasts_ends_with_the_drive(run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    policy = pilot.load(run)
    given: list[object] = []
    monkeypatch.setattr(
        policy.learner,
        "act",
        lambda *_, generator, commitment: given.append(commitment) or torch.zeros(1, 2),
    )
    held(policy, 0)
    policy.act(SEEN)
    assert given == [None]
    held(policy, 20)
    policy.reset(0)
    for _ in range(3):
        policy.act(SEEN)
    assert isinstance(given[-1], Commitment)
    assert given[-1] is given[-2] is given[-3]
    policy.reset(0)
    policy.act(SEEN)
    assert given[-1] is not given[-2]


def test_preset_changes_how_it_acts_and_not_what_it_learnt(run: Path) -> None:
    policy = pilot.load(run, preset="paper")
    sampler = presets.paper("da-ibc").sampler
    assert policy.config.sampler == dataclasses.replace(sampler, precision=resolved("auto"))
    assert policy.config.network == presets.quick("da-ibc").network


@pytest.mark.parametrize(
    ("preset", "is_fast", "expected"),
    [("paper", True, "bfloat16"), ("paper", False, "float32"), ("quick", True, "float32")],
)
def test_config_names_the_number_format_that_acts(
    run: Path, monkeypatch: pytest.MonkeyPatch, *, preset: str, is_fast: bool, expected: str
) -> None:
    """`quick` takes a grid, `paper` searches."""
    monkeypatch.setattr(hardware, "bfloat16_is_fast", lambda device: is_fast)
    assert checkpoint.load_config(run).sampler.precision == "auto"
    assert pilot.load(run, preset=preset).config.sampler.precision == expected


def test_runs_from_before_there_was_a_precision_are_read(run: Path) -> None:
    path = run / checkpoint.CONFIG
    settings = json.loads(path.read_text())
    del settings["sampler"]["precision"]
    path.write_text(json.dumps(settings))
    assert pilot.load(run, preset="paper").config.sampler.precision == resolved("auto")


def test_a_precision_that_does_not_exist_is_refused(run: Path) -> None:
    path = run / checkpoint.CONFIG
    path.write_text(path.read_text().replace('"auto"', '"float16"'))
    with pytest.raises(RunError, match="float16"):
        pilot.load(run)


def test_unknown_preset_and_folders_without_a_run_are_refused(run: Path, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="Did you mean 'paper'"):
        pilot.load(run, preset="papr")
    with pytest.raises(RunError, match="no run folder"):
        pilot.load(tmp_path / "nothing")
    (run / checkpoint.MODEL).write_bytes(b"cut")
    with pytest.raises(RunError, match=r"Cannot read .*model.safetensors"):
        pilot.load(run)


def test_it_acts_by_itself_on_the_gpu_where_there_is_one(
    run: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With stand-ins for all that needs a GPU."""
    gpu, moved, drawing = torch.device("cuda"), [], []
    monkeypatch.setattr(torch.cuda, "is_available", lambda: True)
    monkeypatch.setattr(hardware, "bfloat16_is_fast", lambda device: device == gpu)
    monkeypatch.setattr(Learner, "to", lambda self, device: moved.append(device) or self)
    monkeypatch.setattr(torch, "Generator", drawing.append)
    learner = build_learner(presets.quick("da-ibc"), seed=0)
    policy = pilot.Pilot(learner, name="mine")
    assert policy.device == gpu
    assert (moved, drawing) == ([gpu], [gpu])
    assert policy.config.sampler.precision == "bfloat16"


def test_what_it_sees_goes_to_its_device(run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    elsewhere = torch.device("meta")
    monkeypatch.setattr(torch, "Generator", lambda device: None)
    policy = pilot.load(run, device=elsewhere)
    held(policy, 0)  # no chance to draw there
    seen = []

    def act(
        bev: torch.Tensor, state: torch.Tensor, *, generator: object, commitment: object
    ) -> torch.Tensor:
        seen.extend([bev.device, state.device])
        return torch.zeros(1, 2)

    monkeypatch.setattr(policy.learner, "act", act)
    policy.act(SEEN)
    assert seen == [elsewhere, elsewhere]
