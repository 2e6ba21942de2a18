"""Implicit behavioural cloning: an energy model trained with InfoNCE against uniform negatives."""

import torch
from jaxtyping import Float, UInt8
from torch import Tensor
from torch.nn import functional as F  # noqa: N812

from models.config import LearnerConfig
from models.encoder import Encoder, drop_previous_action
from models.energy import EnergyHead
from models.energy_scoring import EnergyScorer
from models.expert_actions import ExpertActions
from models.interfaces import Batch, Learner, weighted_mean
from models.negatives import uniform_actions
from models.samplers import dfo, grid


def info_nce(
    positive_energy: Float[Tensor, " B"], negative_energies: Float[Tensor, "B N"]
) -> Float[Tensor, " B"]:
    """Negative log-probability of the expert action among itself and its negatives.

    Args:
        positive_energy: Energy of the expert action [nats].
        negative_energies: Energies of its negatives [nats].

    Returns:
        The loss of each observation [nats].

    Reference:
        Florence et al., Implicit Behavioral Cloning, CoRL 2022, (2).
    """
    logits = -torch.cat((positive_energy[:, None], negative_energies), dim=1)  # (B, 1 + N)
    targets = torch.zeros(len(logits), dtype=torch.long, device=logits.device)
    return F.cross_entropy(logits, targets, reduction="none")


class IbcLearner(Learner):
    """Implicit and multimodal: an observation and an action give an energy, and a sampler finds where it is low."""

    def __init__(self, config: LearnerConfig) -> None:
        super().__init__()
        self.config = config
        self.encoder = Encoder(config.network)
        self.energy = EnergyHead(self.encoder.feature_size, action_gain=config.network.action_gain)
        self.experts = ExpertActions()

    def prepare(self, actions: Float[Tensor, "D 2"], density: Float[Tensor, " D"]) -> None:
        """Keep the expert actions [-] and their density [-], from which the search starts."""
        self.experts.remember(actions, density)

    def negatives(self, batch: Batch, *, generator: torch.Generator) -> Float[Tensor, "B N 2"]:
        """Actions to tell the expert's apart from [-]."""
        count = self.config.negatives.count
        return uniform_actions(len(batch.actions), count, generator=generator)

    def log_negative_density(
        self, batch: Batch, candidates: Float[Tensor, "B N 2"]
    ) -> Float[Tensor, "B N"] | None:
        """Log density of the negatives to correct the energies by, or None if that changes nothing [nats].

        Reference:
            Singh, Tu, Sindhwani, Revisiting Energy Based Models as Policies: Ranking Noise Contrastive Estimation
            and Interpolating Energy Models, 2023: trained on -E - log p_n(y), exp(-E) becomes p(y | x) itself.
        """
        del batch, candidates
        return None  # uniform negatives have the same density everywhere

    def loss(
        self, batch: Batch, *, weights: Float[Tensor, " B"] | None, generator: torch.Generator
    ) -> Float[Tensor, ""]:
        """Mean InfoNCE loss against fresh negatives [nats]."""
        state = drop_previous_action(batch.state, self.config.network.state_dropout, generator)
        negatives = self.negatives(batch, generator=generator)
        candidates = torch.cat((batch.actions[:, None], negatives), dim=1)  # (B, 1 + N, 2)
        energies = self.energy(self.encoder(batch.bev, state), candidates)
        log_density = self.log_negative_density(batch, candidates)
        if log_density is not None:
            energies = energies + log_density
        return weighted_mean(info_nce(energies[:, 0], energies[:, 1:]), weights)

    @torch.no_grad()
    def energies(
        self,
        bev: UInt8[Tensor, "B C H W"],
        state: Float[Tensor, "B 3"],
        actions: Float[Tensor, "A N 2"],
    ) -> Float[Tensor, "B N"]:
        """Energies of actions, for landscapes.

        Args:
            bev: Bird's-eye views in 0..255 [-].
            state: Speed [m/s], previous acceleration [-] and previous steering [-].
            actions: Candidates of each observation, or one set (A = 1) that all observations share [-].

        Returns:
            Energies, computed in float32 whatever the settings say [nats].
        """
        return EnergyScorer(self.energy, self.encoder(bev, state), "float32")(actions)

    @torch.no_grad()
    def act(
        self,
        bev: UInt8[Tensor, "B C H W"],
        state: Float[Tensor, "B 3"],
        *,
        generator: torch.Generator,
    ) -> Float[Tensor, "B 2"]:
        """Encode once, in float32, then let the sampler of the settings choose."""
        settings = self.config.sampler
        energy = EnergyScorer(self.energy, self.encoder(bev, state), settings.precision)
        if settings.kind == "grid":
            return grid.choose(energy, settings.grid, generator=generator)
        start = self.experts.draw(len(bev), settings.dfo, generator=generator)
        return dfo.search(energy, start, settings.dfo, generator=generator).actions
