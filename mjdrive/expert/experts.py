"""The experts by name."""

from mjdrive import plugins
from mjdrive.config import ExpertName, MpcConfig, PidConfig
from mjdrive.datatypes import Policy, Situation, Town
from mjdrive.errors import PluginError, UnknownNameError
from mjdrive.expert.pid import PidExpert
from mjdrive.vehicle.parameters import VehicleParameters

NAMES: tuple[ExpertName, ...] = ("pid", "mpc")
"""Experts that come with mjdrive, the paper's first."""


def names() -> tuple[ExpertName, ...]:
    """List the experts that can be chosen: ours, then those of other packages."""
    others = [name for name in plugins.names("expert") if name not in NAMES]
    return (*NAMES, *others)


def known(name: str) -> ExpertName:
    """Make sure that there is an expert of a name.

    Raises:
        UnknownNameError: If there is none.
    """
    if name in names():
        return name
    raise UnknownNameError("expert", name, names())


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
        name: One of `names()`.
        town: Where it drives.
        parameters: Numbers of the car.
        settings: Its own settings; the defaults if None. Experts of other packages keep theirs to themselves.
        control_interval: Time between two decisions [s].
        law: For the MPC expert, the settings of the PID expert that it falls back on, whose speeds and stops are its own.

    Raises:
        UnknownNameError: If there is no such expert.
        SolverError: If the solver of the MPC expert is missing.
        PluginError: If the package that brings it along is broken.
    """
    if known(name) not in NAMES:
        return _of_another_package(name, town, parameters, control_interval)
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


def _of_another_package(
    name: str, town: Town, parameters: VehicleParameters, control_interval: float
) -> Policy[Situation]:
    """Make an expert that an entry point `mjdrive.experts` names."""
    make = plugins.load("expert", name)
    expert = (
        make(town, parameters=parameters, control_interval=control_interval)
        if callable(make)
        else make
    )
    if not isinstance(expert, Policy):
        raise PluginError(
            f"The expert '{name}' of {plugins.source('expert', name)} is a {type(expert).__name__}; expected name, "
            "reset(seed) and act(situation), made by calling the entry point with the town, parameters and control_interval."
        )
    return expert
