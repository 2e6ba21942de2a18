"""What diffusion and flow matching share: a network learns how noise becomes an action, and one pass encodes the picture.

Both mix an action with Gaussian noise, a(t) y + b(t) e, and follow an ordinary differential equation from noise to action.
"""

import math
from abc import abstractmethod

import torch
from jaxtyping import Float, UInt8
from torch import Tensor

from models import ode_density
from models.cells import spread_over_cells
from models.config import LearnerConfig
from models.denoiser import Denoiser
from models.encoder import Encoder, draw_dropout, drop_previous_action
from models.interfaces import ACTION_BOUND, ACTION_SIZE, Batch, Chance, Learner, weighted_mean
from models.samplers.commitment import Commitment
from models.samplers.grid import draw_points
from models.threads import for_each, one_thread

# Hidden layers of this many actions, with their derivatives, are 3 MB.
ROWS_AT_A_TIME = 1024
# Along each axis of the grid that a density is estimated on, where chance lasts: nearer than the noise floor.
POINTS = 65
# Beyond this ratio of noise to action one step is enough.
LARGEST_RATIO = 30.0


class GenerativeLearner(Learner):
    """A policy that draws noise and turns it into an action, given the features of one observation."""

    def __init__(self, config: LearnerConfig) -> None:
        super().__init__()
        self.config = config
        self.encoder = Encoder(config.network)
        self.denoiser = Denoiser(
            self.encoder.feature_size,
            width=config.denoiser.width,
            action_gain=config.denoiser.action_gain,
        )

    @abstractmethod
    def mix(
        self,
        actions: Float[Tensor, "B 1 2"],
        noise: Float[Tensor, "B N 2"],
        times: Float[Tensor, "B N 1"],
    ) -> tuple[Float[Tensor, "B N 2"], Float[Tensor, "B N 2"]]:
        """Mix actions [-] with noise [-], and say what the network is to predict of it [-]."""

    @abstractmethod
    def generate(
        self,
        observed: Float[Tensor, "B 1 H"],
        noise: Float[Tensor, "B N 2"],
        *,
        generator: torch.Generator,
    ) -> Float[Tensor, "B N 2"]:
        """Turn noise [-] into actions [-]; `observed` is from the denoiser."""

    @abstractmethod
    def time_at(self, ratio: float) -> float:
        """Time in [0, 1] at which there is so much noise to an action; math.inf for nothing but noise [-]."""

    @abstractmethod
    def velocity(
        self, observed: Float[Tensor, "1 H"], noisy: Float[Tensor, "N 2"], time: float
    ) -> tuple[Float[Tensor, "N 2"], Float[Tensor, " N"]]:
        """Rate of noisy actions of one observation by time, and its divergence [-]."""

    @abstractmethod
    def action_scale(self, time: float) -> float:
        """Factor a(t) on the action in the mixture [-]."""

    def draw(self, actions: Float[Tensor, "B 2"], *, generator: torch.Generator) -> Chance:
        """Draw dropout, and several noises for each action with times that are spread evenly over [0, 1]."""
        num, draws, device = len(actions), self.config.denoiser.draws, actions.device
        kept = draw_dropout(num, self.config.network.state_dropout, generator=generator)
        noise = torch.randn((num, draws, ACTION_SIZE), generator=generator, device=device)
        first = torch.rand((num, 1), generator=generator, device=device)
        times = (first + torch.arange(draws, device=device) / draws) % 1
        return Chance(keeps_previous=kept, noise=noise, times=times)

    def loss(
        self, batch: Batch, chance: Chance, *, weights: Float[Tensor, " B"] | None
    ) -> Float[Tensor, ""]:
        """Mean squared error of the prediction [-]."""
        assert chance.noise is not None, "draw() gives it"
        assert chance.times is not None, "draw() gives them"
        state = drop_previous_action(batch.state, chance.keeps_previous)
        observed = self.denoiser.observe(self.encoder(batch.bev, state))
        noisy, target = self.mix(batch.actions[:, None], chance.noise, chance.times[..., None])
        errors = self.denoiser(observed, noisy, chance.times) - target
        return weighted_mean(errors.square().mean(dim=(1, 2)), weights)

    @torch.no_grad()
    def act(
        self,
        bev: UInt8[Tensor, "B C H W"],
        state: Float[Tensor, "B 3"],
        *,
        generator: torch.Generator,
        commitment: Commitment | None = None,
    ) -> Float[Tensor, "B 2"]:
        """Encode once, then turn noise into an action; where chance lasts, into many, whose density is drawn from."""
        num_draws = 1 if commitment is None else self.config.denoiser.candidates
        with one_thread():
            observed = self.denoiser.observe(self.encoder(bev, state))
            shape = (len(observed), num_draws, ACTION_SIZE)
            noise = torch.randn(shape, generator=generator, device=observed.device)
            actions = self.generate(observed, noise, generator=generator)
            actions = actions.clamp(-ACTION_BOUND, ACTION_BOUND)
            if commitment is None:
                return actions.squeeze(1)
            log_masses = _log_masses(actions, deviation=self.config.denoiser.noise_floor)
        return draw_points(log_masses, generator=generator, commitment=commitment)

    @torch.no_grad()
    def log_density(
        self,
        bev: UInt8[Tensor, "B C H W"],
        state: Float[Tensor, "B 3"],
        actions: Float[Tensor, "A N 2"],
    ) -> Float[Tensor, "B N"]:
        """Log of the density of actions with the noise floor of the settings, by the probability-flow ODE [nats].

        It is that of what the network has learnt, before steps are made large and actions are brought into their bounds.
        """
        floor = self.config.denoiser.noise_floor
        ratios = ode_density.noise_ratios(floor, LARGEST_RATIO, self.config.denoiser.density_steps)
        times = [self.time_at(ratio) for ratio in (*ratios, math.inf)]
        scale = self.action_scale(times[0])
        with one_thread() as num_threads:
            observed = self.denoiser.observe(self.encoder(bev, state))
            found = actions.new_empty(len(observed), actions.shape[1])
            pieces = [
                (units, rows, out)
                for units, own, row in zip(
                    observed, actions.expand(len(observed), -1, -1), found, strict=True
                )
                for rows, out in zip(
                    own.split(ROWS_AT_A_TIME), row.split(ROWS_AT_A_TIME), strict=True
                )
            ]

            def tell(piece: tuple[Tensor, Tensor, Tensor]) -> None:
                units, rows, out = piece
                out.copy_(
                    ode_density.log_density(
                        lambda noisy, time: self.velocity(units, noisy, time), scale * rows, times
                    )
                )

            for_each(pieces, lambda: tell, num_threads=num_threads)
        return found + ACTION_SIZE * math.log(scale)


def _log_masses(actions: Float[Tensor, "B N 2"], *, deviation: float) -> Float[Tensor, "B P"]:
    """Log of how much of the actions, each spread by a Gaussian, lies in the cell of each point of a grid [nats]."""
    accelerations, steerings = spread_over_cells(
        actions, points=POINTS, deviation=deviation
    ).unbind(dim=2)  # (B, N, POINTS) each
    masses = accelerations.transpose(1, 2) @ steerings / actions.shape[1]
    return masses.flatten(1).clamp_min(torch.finfo(masses.dtype).tiny).log()
