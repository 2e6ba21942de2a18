"""Derivative-free search as published code does it, written anew from its description: the side to beat.

Both kinds tile the feature vector of an observation beside every candidate, run the whole energy network on the pairs in
float32 and resample with `torch.multinomial`. diffusion_policy encodes the observation once a decision; kevinzakka/ibc has
the encoder inside the energy network, so that it runs again each time candidates are scored. (A third kind tiles the
observations themselves, 16384 pictures a pass; it does not fit into memory and is no match.)

Start, noise, clipping and the final draw are those of our settings, so both sides do the same work.
"""

import torch
from jaxtyping import Float, UInt8
from torch import Tensor, nn

from models.config import DfoConfig
from models.ibc import IbcLearner


class NaiveDfo:
    """Chooses actions by a search over the whole network.

    Args:
        learner: A network with its settings; the weights are shared.
        encodes_once: Whether the encoder runs once a decision (diffusion_policy) or at each pass (kevinzakka/ibc).
    """

    def __init__(self, learner: IbcLearner, *, encodes_once: bool) -> None:
        head = learner.energy
        self._encoder = learner.encoder
        self._network = nn.Sequential(head.first, nn.ReLU(), head.second, nn.ReLU(), head.last)
        self._experts = learner.experts
        self._config = learner.config.sampler.dfo
        self._encodes_once = encodes_once

    @torch.no_grad()
    def act(
        self,
        bev: UInt8[Tensor, "1 C H W"],
        state: Float[Tensor, "1 3"],
        *,
        generator: torch.Generator,
    ) -> Float[Tensor, "1 2"]:
        """Choose one action; see `Learner.act`."""
        config = self._config
        features = self._encoder(bev, state)
        candidates, sigma = self._start(generator), config.sigma_init
        for number in range(1, config.iterations + 1):
            if number > 1 and not self._encodes_once:
                features = self._encoder(bev, state)
            probabilities = torch.softmax(-self._energies(features, candidates), dim=0)
            if number == config.iterations:
                break
            drawn = torch.multinomial(
                probabilities, config.num_samples, replacement=True, generator=generator
            )
            candidates = candidates[drawn]
            candidates = candidates + sigma * torch.randn(candidates.shape, generator=generator)
            candidates = candidates.clamp(-config.bound, config.bound)
            sigma *= config.shrink
        return candidates[_choose(probabilities, config, generator)][None]

    def _start(self, generator: torch.Generator) -> Tensor:
        weights = 1 / self._experts.density
        drawn = torch.multinomial(
            weights, self._config.num_samples, replacement=True, generator=generator
        )
        return self._experts.actions[drawn]

    def _energies(self, features: Tensor, candidates: Tensor) -> Tensor:
        """Energies (N) of candidates (N, 2), each joined with the features (1, F)."""
        joined = torch.cat((features.expand(len(candidates), -1), candidates), dim=1)
        energies: Tensor = self._network(joined)
        return energies.squeeze(1)


def _choose(probabilities: Tensor, config: DfoConfig, generator: torch.Generator) -> int:
    """Index of the candidate to drive."""
    if config.choice == "argmin":
        return int(probabilities.argmax())
    return int(torch.multinomial(probabilities, 1, generator=generator))
