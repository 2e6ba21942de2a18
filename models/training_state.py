"""What changes from step to step: weights, moments of Adam, and the running mean of the weights."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager

import torch
from torch import Tensor

from models.config import OptimiserConfig
from models.errors import CheckpointError
from models.interfaces import Learner

MOMENTS = ("step", "exp_avg", "exp_avg_sq")


class TrainingState:
    """Optimiser and running mean of one learner; all of it goes into a flat dictionary of tensors and back."""

    def __init__(self, learner: Learner, settings: OptimiserConfig) -> None:
        self._settings = settings
        self._parameters = dict(learner.named_parameters())
        # AdamW is Adam where the weight decay is zero.
        self._optimiser = torch.optim.AdamW(
            self._parameters.values(),
            lr=settings.learning_rate,
            weight_decay=settings.weight_decay,
            fused=True,
        )
        self._means = {
            name: parameter.detach().clone() for name, parameter in self._parameters.items()
        }

    def clear_gradients(self) -> None:
        """Forget the gradients of the step before."""
        self._optimiser.zero_grad(set_to_none=True)

    def gradients(self) -> list[Tensor]:
        """The gradient of each weight, zeros where there is none."""
        for parameter in self._parameters.values():
            if parameter.grad is None:
                parameter.grad = torch.zeros_like(parameter)
        return [
            parameter.grad for parameter in self._parameters.values() if parameter.grad is not None
        ]

    def descend(self, learning_rate: float) -> float:
        """Take one step against the gradients.

        Args:
            learning_rate: Step size [-].

        Returns:
            Norm of the gradient before clipping [-].
        """
        clip = self._settings.gradient_clip
        norm = torch.nn.utils.clip_grad_norm_(
            self._parameters.values(), float("inf") if clip is None else clip
        )
        for group in self._optimiser.param_groups:
            group["lr"] = learning_rate
        self._optimiser.step()
        if self._settings.ema_decay > 0:
            with torch.no_grad():
                for name, parameter in self._parameters.items():
                    self._means[name].lerp_(parameter, 1 - self._settings.ema_decay)
        return norm.item()

    def tensors(self) -> dict[str, Tensor]:
        """Everything that the next step depends on."""
        tensors = {}
        for name, parameter in self._parameters.items():
            tensors[f"weight/{name}"] = parameter.detach()
            tensors[f"mean/{name}"] = self._means[name]
            for moment in MOMENTS:
                tensors[f"{moment}/{name}"] = self._optimiser.state[parameter][moment]
        return tensors

    @torch.no_grad()
    def restore(self, tensors: Mapping[str, Tensor]) -> None:
        """Take up where `tensors` were taken.

        Raises:
            CheckpointError: If a tensor is missing or of another shape.
        """
        try:
            for name, parameter in self._parameters.items():
                parameter.copy_(tensors[f"weight/{name}"])
                self._means[name].copy_(tensors[f"mean/{name}"])
                self._optimiser.state[parameter] = {
                    "step": tensors[f"step/{name}"].to(parameter.device),
                    "exp_avg": torch.empty_like(parameter).copy_(tensors[f"exp_avg/{name}"]),
                    "exp_avg_sq": torch.empty_like(parameter).copy_(tensors[f"exp_avg_sq/{name}"]),
                }
        except (KeyError, RuntimeError) as error:
            raise CheckpointError(f"The training state is of another network: {error}") from error

    @torch.no_grad()
    def put_weights_to_act(self) -> None:
        """Give the learner the running means, where they are kept."""
        if self._settings.ema_decay > 0:
            for name, parameter in self._parameters.items():
                parameter.copy_(self._means[name])

    @contextmanager
    def weights_to_act(self) -> Iterator[None]:
        """Within it, the learner has the weights to act with; after it, those to train on."""
        trained = {name: parameter.detach().clone() for name, parameter in self._parameters.items()}
        self.put_weights_to_act()
        try:
            yield
        finally:
            with torch.no_grad():
                for name, parameter in self._parameters.items():
                    parameter.copy_(trained[name])
