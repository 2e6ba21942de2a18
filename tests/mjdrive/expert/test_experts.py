import pytest

from mjdrive.config import MpcConfig, PidConfig
from mjdrive.datatypes import Policy, Town
from mjdrive.errors import UnknownNameError
from mjdrive.expert import experts
from mjdrive.vehicle.parameters import VehicleParameters


@pytest.mark.parametrize("name", experts.NAMES)
def test_experts_are_policies_of_their_name(name: str, town02: Town) -> None:
    expert = experts.make_expert(name, town02, parameters=VehicleParameters.default())
    assert isinstance(expert, Policy)
    assert expert.name == name


def test_settings_of_an_expert_reach_it(town02: Town) -> None:
    car = VehicleParameters.default()
    pid = experts.make_expert("pid", town02, parameters=car, settings=PidConfig(target_speed=5.0))
    mpc = experts.make_expert("mpc", town02, parameters=car, settings=MpcConfig(horizon=1.5))
    assert pid.config.target_speed == 5.0  # type: ignore[attr-defined]
    assert mpc.config.horizon == 1.5  # type: ignore[attr-defined]


def test_unknown_expert_is_refused(town02: Town) -> None:
    with pytest.raises(UnknownNameError, match=r"Unknown expert 'pdi'. Known: mpc, pid"):
        experts.make_expert("pdi", town02, parameters=VehicleParameters.default())
