"""The expert's actions, kept inside a network so that its checkpoint can start a search from them and undo what they tilted."""

from collections.abc import Mapping

import torch
from jaxtyping import Float
from torch import Tensor, nn

from models import lattice, undoing
from models.config import LearnerConfig, Start
from models.interfaces import ACTION_SIZE
from models.negatives import uniform_actions
from models.samplers.draws import draw_ascending, pick

STORED = ("experts.actions", "experts.density")
"""What a learner calls its expert actions and their densities."""


class ExpertActions(nn.Module):
    """Every expert action with its density; saved and loaded with the weights, whatever their number."""

    def __init__(self) -> None:
        super().__init__()
        self.register_buffer("actions", torch.empty(0, ACTION_SIZE))
        self.register_buffer("density", torch.empty(0))
        # Follows from both and from the settings, so it is not saved.
        self.register_buffer("_surface", torch.empty(0), persistent=False)
        self._surface_of: object = None
        self.actions: Tensor
        self.density: Tensor
        self._surface: Tensor

    def remember(self, actions: Float[Tensor, "D 2"], density: Float[Tensor, " D"]) -> None:
        """Keep expert actions [-] and the density at each [-]."""
        self.actions = actions.detach().clone()
        self.density = density.detach().clone()
        self._surface_of = None

    def tilt(
        self, config: LearnerConfig, actions: Float[Tensor, "A N 2"]
    ) -> Float[Tensor, "3 A N"]:
        """What `sampler.undo` adds to the log density of actions, and its slopes.

        Args:
            config: Settings of the learner, whose `sampler.undo` is not "none".
            actions: Actions in [-1, 1] [-].

        Returns:
            The addition and its slopes along acceleration and steering [nats].
        """
        key = config.sampler.undo, config.negatives, config.density
        if self._surface_of != key:
            assert len(self.actions) > 0, "prepare() has not been called"
            self._surface = undoing.surface(config, self.actions, self.density)
            self._surface_of = key
        return lattice.read(self._surface, actions)

    def draw(
        self, num_observations: int, count: int, start: Start, *, generator: torch.Generator
    ) -> Float[Tensor, "B N 2"]:
        """First candidates of a search.

        Args:
            num_observations: How many observations need candidates.
            count: Candidates of each.
            start: How expert actions are weighted, or "uniform" for none of them.
            generator: Source of chance, on the device of the actions.

        Returns:
            One independent set an observation, in the order of the expert actions [-].
        """
        if start == "uniform":
            return uniform_actions(num_observations, count, generator=generator)
        assert len(self.actions) > 0, "prepare() has not been called"
        # The text of the paper weighs by 1 / KDE, its Algorithm 1 by KDE.
        weights = self.density if start == "kde" else self.density.reciprocal()
        drawn = draw_ascending(weights.expand(num_observations, -1), count, generator=generator)
        return pick(self.actions.expand(num_observations, -1, -1), drawn)

    def _load_from_state_dict(
        self, state_dict: dict[str, Tensor], prefix: str, *args: object
    ) -> None:
        """Take as many actions as the checkpoint holds."""
        for name in ("actions", "density"):
            saved = state_dict.get(prefix + name)
            if saved is not None:
                setattr(self, name, torch.empty_like(saved, device=getattr(self, name).device))
        self._surface_of = None
        super()._load_from_state_dict(state_dict, prefix, *args)


def thinned(tensors: Mapping[str, Tensor], most: int) -> dict[str, Tensor]:
    """Keep some expert actions of a learner that keeps them, evenly over the demonstrations.

    Args:
        tensors: Of a learner, by name.
        most: Expert actions to keep at most [-].

    Returns:
        The same with fewer expert actions, each with the density that it had among all.
    """
    counts = [len(tensors[name]) for name in STORED if name in tensors]
    if not counts or counts[0] <= most:
        return dict(tensors)
    kept = torch.arange(most) * counts[0] // most
    return {
        name: values[kept.to(values.device)] if name in STORED else values
        for name, values in tensors.items()
    }
