"""Policies that a page can choose by name, and how each is loaded; a name is never a path."""

from pathlib import Path

from mjdrive import plugins
from mjdrive.episodes import plugged
from mjdrive.errors import UnknownNameError
from mjdrive.expert import experts
from mjdrive.learning import pilot, runs
from mjdrive.web.policies import ExpertMind, GuestMind, Mind, PilotMind
from mjdrive.zoo import entries


def policy_names(folder: Path) -> tuple[str, ...]:
    """List what can be chosen: trained runs, shipped policies, experts, policies of other packages.

    Args:
        folder: Of run folders.
    """
    found = (*run_names(folder), *entries.full_names(), *experts.names(), *plugins.names("policy"))
    return tuple(dict.fromkeys(found))


def run_names(folder: Path) -> tuple[str, ...]:
    """List the training runs in a folder that links do not lead out of.

    Args:
        folder: Of run folders.
    """
    home = folder.resolve()
    found = (it for it in folder.glob("[!.]*") if it.resolve().parent == home and runs.is_run(it))
    return tuple(sorted(it.name for it in found))


def load_mind(name: str, folder: Path) -> Mind:
    """Load a policy by its name in the list; of equal names, `mjdrive drive` takes the same.

    Args:
        name: One of `policy_names`.
        folder: Of run folders.

    Raises:
        UnknownNameError: If it is not in the list.
        RunError: If the run is damaged or gone.
        PluginError: If the package that brings it along is broken.
    """
    if name not in policy_names(folder):
        raise UnknownNameError("policy", name, policy_names(folder))
    if name in experts.names():
        return ExpertMind(name)
    if name in plugins.names("policy"):
        return GuestMind(name, plugged.make_policy(name))
    place = entries.find(name) if name.startswith(entries.PREFIX) else folder / name
    return PilotMind(pilot.load(place, name=name))
