"""The experts by name."""

from mjdrive.config import ExpertName, MpcConfig, PidConfig
from mjdrive.datatypes import Policy, Situation, Town
from mjdrive.errors import UnknownNameError
from mjdrive.expert.pid import PidExpert
from mjdrive.vehicle.parameters import VehicleParameters

NAMES: tuple[ExpertName, ...] = ("pid", "mpc")
"""Experts that can be chosen, the paper's first."""


def known(name: str) -> ExpertName:
    """Make sure that there is an expert of a name.

    Raises:
        UnknownNameError: If there is none.
    """
    for expert in NAMES:
        if expert == name:
            return expert
    raise UnknownNameError("expert", name, NAMES)


def make_expert(
    name: str,
    town: Town,
    *,
    parameters: VehicleParameters,
    settings: PidConfig | MpcConfig | None = None,
    control_interval: float = 0.1,
    law: PidConfig | None = None,
) -> Policy[Situation]:
    """Make an expert that knows its car.

    Args:
        name: One of `NAMES`.
        town: Where it drives.
        parameters: Numbers of the car.
        settings: Its own settings; the defaults if None.
        control_interval: Time between two decisions [s].
        law: For the MPC expert, the settings of the PID expert that it falls back on, whose speeds and stops are its own.

    Raises:
        UnknownNameError: If there is no such expert.
        SolverError: If the solver of the MPC expert is missing.
    """
    if known(name) == "pid":
        assert not isinstance(settings, MpcConfig), "settings of another expert"
        return PidExpert(
            town, parameters=parameters, config=settings, control_interval=control_interval
        )
    from mjdrive.expert.mpc import MpcExpert  # noqa: PLC0415  (casadi takes a while)

    assert not isinstance(settings, PidConfig), "settings of another expert"
    return MpcExpert(
        town,
        parameters=parameters,
        config=settings,
        control_interval=control_interval,
        fallback=law,
    )
