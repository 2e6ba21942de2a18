"""Policies that other packages bring along, made ready to drive."""

from mjdrive import plugins
from mjdrive.datatypes import Observation, Policy
from mjdrive.errors import PluginError


def make_policy(name: str) -> Policy[Observation]:
    """Make a policy that an entry point `mjdrive.policies` names.

    Args:
        name: One of `plugins.names("policy")`.

    Raises:
        UnknownNameError: If no package brings such a policy.
        PluginError: If the package that brings it along is broken.
    """
    make = plugins.load("policy", name)
    try:
        policy = make() if callable(make) else make
    except Exception as error:  # whatever another package does wrong is its own mistake
        raise PluginError(
            f"The policy '{name}' of {plugins.source('policy', name)} cannot be made: {type(error).__name__}: {error}. "
            "Expected the entry point to need nothing when it is called; mend or remove that package."
        ) from error
    if not isinstance(policy, Policy):
        raise PluginError(
            f"The policy '{name}' of {plugins.source('policy', name)} is a {type(policy).__name__}; expected name, "
            "reset(seed) and act(observation), made by calling the entry point with nothing."
        )
    return policy
