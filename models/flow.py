"""Flow-matching policy: a velocity carries noise to an action on paths that are straight in the mean.

At time t an action y is mixed with noise e as t y + (1 - t) e; time runs from noise to action.
"""

from itertools import pairwise

import torch
from jaxtyping import Float
from torch import Tensor

from models.generative import GenerativeLearner


class FlowLearner(GenerativeLearner):
    """Implicit and multimodal: the network predicts the velocity y - e of the mixture.

    Reference:
        Lipman et al., Flow Matching for Generative Modeling, ICLR 2023, (23) with sigma_min = 0; Liu, Gong, Liu, Flow
        Straight and Fast, ICLR 2023.
    """

    def mix(
        self,
        actions: Float[Tensor, "B 1 2"],
        noise: Float[Tensor, "B N 2"],
        times: Float[Tensor, "B N 1"],
    ) -> tuple[Float[Tensor, "B N 2"], Float[Tensor, "B N 2"]]:
        """Go a share of the way from noise to action, and give the velocity as the target [-]."""
        return times * actions + (1 - times) * noise, actions - noise

    def generate(
        self,
        observed: Float[Tensor, "B 1 H"],
        noise: Float[Tensor, "B N 2"],
        *,
        generator: torch.Generator,
    ) -> Float[Tensor, "B N 2"]:
        """Follow the velocity in equal steps [-]; all chance lies in the noise."""
        del generator
        settings = self.config.flow
        noisy = noise
        for start, end in pairwise(step / settings.steps for step in range(settings.steps + 1)):
            velocity = self.denoiser(observed, noisy, start)
            if settings.integrator == "midpoint":
                middle = noisy + (end - start) / 2 * velocity
                velocity = self.denoiser(observed, middle, (start + end) / 2)
            noisy = noisy + (end - start) * velocity
        return noisy

    def time_at(self, ratio: float) -> float:
        """Time at which (1 - t) / t is the ratio [-]."""
        return 1 / (1 + ratio)

    def action_scale(self, time: float) -> float:
        """The time itself [-]."""
        return time

    def velocity(
        self, observed: Float[Tensor, "1 H"], noisy: Float[Tensor, "N 2"], time: float
    ) -> tuple[Float[Tensor, "N 2"], Float[Tensor, " N"]]:
        """What the network predicts [-]."""
        return self.denoiser.with_divergence(observed, noisy, time)
