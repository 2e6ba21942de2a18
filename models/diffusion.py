"""Diffusion policy: an action is denoised step by step along the cosine schedule.

At time t an action y is mixed with noise e by an angle, cos(phi) y + sin(phi) e with phi = t pi / 2.
"""

import math
from itertools import pairwise

import torch
from jaxtyping import Float
from torch import Tensor

from models.generative import GenerativeLearner
from models.interfaces import ACTION_BOUND

# Where there is nothing but noise, it tells nothing of the action: an error in it moves the action by 13 times that here.
LAST_TIME_OF_NOISE = 0.95


class DiffusionLearner(GenerativeLearner):
    """Implicit and multimodal: the network predicts the noise in an action, or the rate v at which it turns into noise.

    Reference:
        Ho, Jain, Abbeel, Denoising Diffusion Probabilistic Models, NeurIPS 2020; Salimans, Ho, Progressive Distillation for
        Fast Sampling of Diffusion Models, ICLR 2022, appendix D, for v and angles; Chi et al., Diffusion Policy, RSS 2023.
    """

    def mix(
        self,
        actions: Float[Tensor, "B 1 2"],
        noise: Float[Tensor, "B N 2"],
        times: Float[Tensor, "B N 1"],
    ) -> tuple[Float[Tensor, "B N 2"], Float[Tensor, "B N 2"]]:
        """Turn actions towards noise by an angle, and give the noise or v as the target [-]."""
        angles = math.pi / 2 * times
        noisy = angles.cos() * actions + angles.sin() * noise
        if self.config.diffusion.prediction == "epsilon":
            return noisy, noise
        return noisy, angles.cos() * noise - angles.sin() * actions

    def generate(
        self,
        observed: Float[Tensor, "B 1 H"],
        noise: Float[Tensor, "B N 2"],
        *,
        generator: torch.Generator,
    ) -> Float[Tensor, "B N 2"]:
        """Denoise in steps of equal angle; the last one gives the clean action that the network sees [-]."""
        settings = self.config.diffusion
        first = self.time_at(math.inf)
        times = [first * (1 - step / settings.steps) for step in range(settings.steps + 1)]
        noisy = noise
        for now, then in pairwise(times):
            clean, residue = self._split(observed, noisy, now)
            fresh = 0.0
            if settings.sampler == "ddpm":
                fresh = _fresh_noise(math.pi / 2 * now, math.pi / 2 * then)
            level = math.sin(math.pi / 2 * then)
            kept = math.sqrt(max(level**2 - fresh**2, 0.0))
            noisy = math.cos(math.pi / 2 * then) * clean + kept * residue
            if fresh > 0:
                noisy = noisy + fresh * torch.randn(
                    noise.shape, generator=generator, device=noise.device
                )
        return noisy

    def _split(self, observed: Tensor, noisy: Tensor, time: float) -> tuple[Tensor, Tensor]:
        """What the network takes for the clean action, and the noise that then remains."""
        cos, sin = math.cos(math.pi / 2 * time), math.sin(math.pi / 2 * time)
        predicted = self.denoiser(observed, noisy, time)
        if self.config.diffusion.prediction == "epsilon":
            clean = (noisy - sin * predicted) / cos
        else:
            clean = cos * noisy - sin * predicted
        if self.config.diffusion.clip:
            clean = clean.clamp(-ACTION_BOUND, ACTION_BOUND)
        return clean, (noisy - cos * clean) / sin

    def time_at(self, ratio: float) -> float:
        """Share of a right angle whose tangent is the ratio [-]."""
        time = 2 / math.pi * math.atan(ratio)
        predicts_noise = self.config.diffusion.prediction == "epsilon"
        return min(time, LAST_TIME_OF_NOISE) if predicts_noise else time

    def action_scale(self, time: float) -> float:
        """Cosine of the angle [-]."""
        return math.cos(math.pi / 2 * time)

    def velocity(
        self, observed: Float[Tensor, "1 H"], noisy: Float[Tensor, "N 2"], time: float
    ) -> tuple[Float[Tensor, "N 2"], Float[Tensor, " N"]]:
        """Probability flow: by angle its rate is v itself [-]."""
        rate, divergence = self.denoiser.with_divergence(observed, noisy, time)
        if self.config.diffusion.prediction == "epsilon":
            cos, sin = math.cos(math.pi / 2 * time), math.sin(math.pi / 2 * time)
            rate = (rate - sin * noisy) / cos
            divergence = (divergence - noisy.shape[1] * sin) / cos
        return math.pi / 2 * rate, math.pi / 2 * divergence


def _fresh_noise(now: float, then: float) -> float:
    """Standard deviation of the noise of a DDPM step between two angles [rad], Ho et al. (7) [-]."""
    share = max(1 - (math.cos(now) / math.cos(then)) ** 2, 0.0)
    return math.sin(then) / math.sin(now) * math.sqrt(share)
