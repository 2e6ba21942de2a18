"""The expert's actions, kept inside a network so that its checkpoint can start a search from them."""

import torch
from jaxtyping import Float
from torch import Tensor, nn

from models.config import DfoConfig
from models.interfaces import ACTION_SIZE
from models.negatives import uniform_actions
from models.samplers.draws import draw_ascending, pick


class ExpertActions(nn.Module):
    """Every expert action with its density; saved and loaded with the weights, whatever their number."""

    def __init__(self) -> None:
        super().__init__()
        self.register_buffer("actions", torch.empty(0, ACTION_SIZE))
        self.register_buffer("density", torch.empty(0))
        self.actions: Tensor
        self.density: Tensor

    def remember(self, actions: Float[Tensor, "D 2"], density: Float[Tensor, " D"]) -> None:
        """Keep expert actions [-] and the density at each [-]."""
        self.actions = actions.detach().clone()
        self.density = density.detach().clone()

    def draw(
        self, num_observations: int, config: DfoConfig, *, generator: torch.Generator
    ) -> Float[Tensor, "B N 2"]:
        """First candidates of a search.

        Args:
            num_observations: How many observations need candidates.
            config: Number of candidates, and how expert actions are weighted.
            generator: Source of chance, on the device of the actions.

        Returns:
            One independent set an observation, in the order of the expert actions [-].
        """
        if config.start == "uniform":
            return uniform_actions(num_observations, config.num_samples, generator=generator)
        assert len(self.actions) > 0, "prepare() has not been called"
        # The text of the paper weighs by 1 / KDE, its Algorithm 1 by KDE.
        weights = self.density if config.start == "kde" else self.density.reciprocal()
        drawn = draw_ascending(
            weights.expand(num_observations, -1), config.num_samples, generator=generator
        )
        return pick(self.actions.expand(num_observations, -1, -1), drawn)

    def _load_from_state_dict(
        self, state_dict: dict[str, Tensor], prefix: str, *args: object
    ) -> None:
        """Take as many actions as the checkpoint holds."""
        for name in ("actions", "density"):
            saved = state_dict.get(prefix + name)
            if saved is not None:
                setattr(self, name, torch.empty_like(saved, device=getattr(self, name).device))
        super()._load_from_state_dict(state_dict, prefix, *args)
