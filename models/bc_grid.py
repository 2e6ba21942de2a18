"""Behavioural cloning with a categorical distribution over a grid of actions: explicit, with any number of modes."""

import torch
from jaxtyping import Float, UInt8
from torch import Tensor, nn
from torch.nn import functional as F  # noqa: N812

from models.cells import cell_areas, nearest_points, spread_over_cells
from models.config import LearnerConfig
from models.encoder import HIDDEN_SIZE, Encoder, draw_dropout, drop_previous_action, policy_head
from models.interfaces import Batch, Chance, Learner, weighted_mean
from models.samplers.commitment import Commitment
from models.samplers.grid import action_grid, draw_points
from models.threads import one_thread


class BcGridLearner(Learner):
    """Explicit and multimodal: one logit for each pair of an acceleration and a steering.

    What is learnt is a density that is constant in the cell of each point, which reaches halfway to its neighbours.
    """

    def __init__(self, config: LearnerConfig) -> None:
        super().__init__()
        self.config = config
        self.encoder = Encoder(config.network)
        self.head = policy_head(self.encoder.feature_size)
        self.logits = nn.Linear(HIDDEN_SIZE, config.categorical.points**2)

    def log_probabilities(
        self, bev: UInt8[Tensor, "B C H W"], state: Float[Tensor, "B 3"]
    ) -> Float[Tensor, "B N"]:
        """Log probability of each point of the grid [nats], acceleration outermost, in single precision."""
        hidden = self.head(self.encoder(bev, state))
        return F.log_softmax(self.logits(hidden).float(), dim=1)

    def draw(self, actions: Float[Tensor, "B 2"], *, generator: torch.Generator) -> Chance:
        """Draw dropout; smoothing leaves nothing else to chance."""
        probability = self.config.network.state_dropout
        return Chance(keeps_previous=draw_dropout(len(actions), probability, generator=generator))

    def loss(
        self, batch: Batch, chance: Chance, *, weights: Float[Tensor, " B"] | None
    ) -> Float[Tensor, ""]:
        """Mean cross-entropy between the smoothed labels and the grid [nats]."""
        settings = self.config.categorical
        state = drop_previous_action(batch.state, chance.keeps_previous)
        log_probabilities = self.log_probabilities(batch.bev, state).unflatten(
            1, (settings.points, settings.points)
        )
        targets = spread_over_cells(
            batch.actions, points=settings.points, deviation=settings.smoothing
        )
        # No matrix product, which would be autocast.
        shares = targets[:, 0, :, None] * targets[:, 1, None, :]  # (B, P, P)
        losses = -(shares * log_probabilities).sum(dim=(1, 2))
        return weighted_mean(losses, weights)

    @torch.no_grad()
    def act(
        self,
        bev: UInt8[Tensor, "B C H W"],
        state: Float[Tensor, "B 3"],
        *,
        generator: torch.Generator,
        commitment: Commitment | None = None,
    ) -> Float[Tensor, "B 2"]:
        """The densest point, or one drawn from the grid, as the settings say."""
        settings = self.config.categorical
        with one_thread():
            log_probabilities = self.log_probabilities(bev, state)
        log_areas = cell_areas(settings.points, device=log_probabilities.device).log()
        log_densities = log_probabilities - log_areas
        if settings.choice == "argmax":
            actions = action_grid(settings.points, device=log_probabilities.device)
            return actions[log_densities.argmax(dim=1)]
        # The density is tempered, so that the coldest sample is the densest point.
        log_weights = log_densities / settings.temperature + log_areas
        return draw_points(log_weights, generator=generator, commitment=commitment)

    @torch.no_grad()
    def log_density(
        self,
        bev: UInt8[Tensor, "B C H W"],
        state: Float[Tensor, "B 3"],
        actions: Float[Tensor, "A N 2"],
    ) -> Float[Tensor, "B N"]:
        """Log of the density of actions: the probability of the cell that each lies in, by its area [nats]."""
        points = self.config.categorical.points
        with one_thread():
            log_probabilities = self.log_probabilities(bev, state)
        areas = cell_areas(points, device=log_probabilities.device)
        nearest = nearest_points(actions, points=points)
        cells = (nearest[..., 0] * points + nearest[..., 1]).expand(len(bev), -1)  # (B, N)
        return (log_probabilities - areas.log()).gather(1, cells)
