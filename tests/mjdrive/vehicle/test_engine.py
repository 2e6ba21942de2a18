import mujoco
import numpy as np
import pytest

from mjdrive.errors import PhysicsError
from mjdrive.vehicle import engine


@pytest.fixture
def broken() -> mujoco.MjData:
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    data.qvel[0] = np.nan
    mujoco.mj_step(model, data)
    return data


def test_warnings_are_counted_and_leave_no_file(tmp_path, monkeypatch, request):
    monkeypatch.chdir(tmp_path)
    assert engine.num_warnings(request.getfixturevalue("broken")) == 1
    assert list(tmp_path.iterdir()) == []


def test_warnings_are_counted_when_another_package_takes_the_hook(request):
    ours = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _: None)
    try:
        assert engine.num_warnings(request.getfixturevalue("broken")) == 1
    finally:
        mujoco.set_mju_user_warning(ours)


def test_simulation_with_values_that_are_not_numbers_is_refused(broken):
    with pytest.raises(PhysicsError, match="BADQVEL"):
        engine.require_sane(broken)
