"""Implicit behavioural cloning: an energy model trained with InfoNCE against uniform negatives."""

from collections.abc import Callable

import torch
from jaxtyping import Float, UInt8
from torch import Tensor

from models.config import LearnerConfig
from models.contrast import contrastive_loss
from models.encoder import Encoder, draw_dropout, drop_previous_action
from models.energy import EnergyHead
from models.energy_scoring import EnergyScorer, resolved_for
from models.energy_slopes import EnergySlopes
from models.expert_actions import ExpertActions
from models.grid_scoring import GridScorer
from models.interfaces import Batch, Chance, Learner
from models.negatives import uniform_actions
from models.samplers import dfo, grid, langevin
from models.samplers.commitment import Commitment
from models.samplers.dfo import EnergyFunction
from models.samplers.langevin import SlopeFunction
from models.threads import one_thread


class IbcLearner(Learner):
    """Implicit and multimodal: an observation and an action give an energy, and a sampler finds where it is low.

    Attributes:
        on_candidates: Shown the candidates of each iteration where the sampler is DFO, to look at the search.
        on_energies: Shown the energies of all points where the sampler is the grid, to look at the choice.
    """

    on_candidates: Callable[[Tensor], None] | None = None
    on_energies: Callable[[Tensor], None] | None = None

    def __init__(self, config: LearnerConfig) -> None:
        super().__init__()
        self.config = config
        self.encoder = Encoder(config.network)
        self.energy = EnergyHead(self.encoder.feature_size, action_gain=config.network.action_gain)
        self.experts = ExpertActions()

    def prepare(self, actions: Float[Tensor, "D 2"], density: Float[Tensor, " D"]) -> None:
        """Keep the expert actions [-] and their density [-], from which the search starts."""
        self.experts.remember(actions, density)

    def draw(self, actions: Float[Tensor, "B 2"], *, generator: torch.Generator) -> Chance:
        """Draw dropout, and fresh negatives."""
        probability = self.config.network.state_dropout
        kept = draw_dropout(len(actions), probability, generator=generator)
        pool = self.pool(actions)
        negatives = self.negatives(len(actions), pool, generator=generator)
        return Chance(keeps_previous=kept, negatives=negatives, pool=pool)

    def pool(self, actions: Float[Tensor, "B 2"]) -> Float[Tensor, "P 2"]:
        """Expert actions [-] that negatives are made from, given those of the minibatch; none for uniform ones."""
        return actions[:0]

    def negatives(
        self, num_observations: int, pool: Float[Tensor, "P 2"], *, generator: torch.Generator
    ) -> Float[Tensor, "B N 2"]:
        """Actions to tell the expert's apart from [-]."""
        del pool
        count = self.config.negatives.count
        return uniform_actions(num_observations, count, generator=generator)

    def log_negative_density(
        self, candidates: Float[Tensor, "B N 2"], pool: Float[Tensor, "P 2"]
    ) -> Float[Tensor, "B N"] | None:
        """Log density of the negatives to correct the energies by, or None if that changes nothing [nats].

        Reference:
            Singh, Tu, Sindhwani, Revisiting Energy Based Models as Policies: Ranking Noise Contrastive Estimation
            and Interpolating Energy Models, 2023: trained on -E - log p_n(y), exp(-E) becomes p(y | x) itself.
        """
        del candidates, pool
        return None  # uniform negatives have the same density everywhere

    def loss(
        self, batch: Batch, chance: Chance, *, weights: Float[Tensor, " B"] | None
    ) -> Float[Tensor, ""]:
        """Mean InfoNCE loss of the expert actions against their negatives [nats]."""
        assert chance.negatives is not None, "draw() gives them"
        assert chance.pool is not None, "draw() gives it"
        state = drop_previous_action(batch.state, chance.keeps_previous)
        candidates = torch.cat((batch.actions[:, None], chance.negatives), dim=1)  # (B, 1 + N, 2)
        return contrastive_loss(
            self.energy,
            self.encoder(batch.bev, state),
            candidates,
            offsets=self.log_negative_density(candidates, chance.pool),
            weights=weights,
        )

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
    def log_density(
        self,
        bev: UInt8[Tensor, "B C H W"],
        state: Float[Tensor, "B 3"],
        actions: Float[Tensor, "A N 2"],
    ) -> Float[Tensor, "B N"]:
        """What the energy says of actions, less what `sampler.undo` takes out [nats]."""
        scorer = EnergyScorer(self.energy, self.encoder(bev, state), "float32")
        return -self._undone(scorer)(actions)

    def _scorer(self, features: Float[Tensor, "B F"], *, num_threads: int) -> EnergyFunction:
        """Who scores what the sampler hands over: a grid in float32 on a CPU by tiles, all else candidate by candidate."""
        settings = self.config.sampler
        precision = resolved_for(settings, features.device)
        by_tiles = settings.kind == "grid" and precision == "float32"
        if by_tiles and features.device.type == "cpu":
            return GridScorer(self.energy, features, num_threads=num_threads)
        return EnergyScorer(self.energy, features, precision, num_threads=num_threads)

    def _undone(self, energy: EnergyFunction) -> EnergyFunction:
        """The energy that acting goes by: without what the settings take out of it."""
        if self.config.sampler.undo == "none":
            return energy
        return lambda actions: energy(actions) - self.experts.tilt(self.config, actions)[0]

    def _undone_slopes(self, slopes: SlopeFunction) -> SlopeFunction:
        """Slopes of the energy that acting goes by."""
        if self.config.sampler.undo == "none":
            return slopes
        return lambda actions: (
            slopes(actions) - self.experts.tilt(self.config, actions)[1:].movedim(0, -1)
        )

    @torch.no_grad()
    def act(
        self,
        bev: UInt8[Tensor, "B C H W"],
        state: Float[Tensor, "B 3"],
        *,
        generator: torch.Generator,
        commitment: Commitment | None = None,
    ) -> Float[Tensor, "B 2"]:
        """Encode once, in float32, then let the sampler of the settings choose."""
        settings = self.config.sampler
        with one_thread() as num_threads:
            features = self.encoder(bev, state)
            energy = self._undone(self._scorer(features, num_threads=num_threads))
            if settings.kind == "grid":
                return grid.choose(
                    energy,
                    settings.grid,
                    generator=generator,
                    commitment=commitment,
                    on_energies=self.on_energies,
                )
            if settings.kind == "dfo":
                search = settings.dfo
                start = self.experts.draw(
                    len(bev), search.num_samples, search.start, generator=generator
                )
                return dfo.search(
                    energy, start, search, generator=generator, on_candidates=self.on_candidates
                ).actions
            slopes = self._undone_slopes(EnergySlopes(self.energy, features, settings.precision))
            walks = settings.langevin
            start = self.experts.draw(len(bev), walks.num_chains, walks.start, generator=generator)
            return langevin.search(energy, slopes, start, walks, generator=generator)
