"""Every setting of the learners, among them each ambiguity of the paper; presets are in `models.presets`."""

import dataclasses
from typing import Literal, get_args

from models.errors import SettingError

Method = Literal["bc-beta", "ibc", "da-ibc"]
StateInput = Literal["speed", "previous_acceleration", "previous_steering"]
DensityKind = Literal["joint", "product"]
Choice = Literal["sample", "argmin"]
Precision = Literal["auto", "float32", "bfloat16"]

METHODS: tuple[Method, ...] = get_args(Method)
STATE_INPUTS: tuple[StateInput, ...] = get_args(StateInput)


def _require(config: object, name: str, condition: bool, expected: str) -> None:
    if not condition:
        raise SettingError(f"{name} is {getattr(config, name)!r}; expected {expected}.")


def _require_positive(config: object, *names: str) -> None:
    for name in names:
        _require(config, name, getattr(config, name) > 0, "a positive number")


def _require_not_negative(config: object, name: str) -> None:
    _require(config, name, getattr(config, name) >= 0, "zero or a positive number")


def _require_share(config: object, name: str) -> None:
    _require(config, name, 0 <= getattr(config, name) <= 1, "a share in [0, 1]")


@dataclasses.dataclass(frozen=True, slots=True)
class NetworkConfig:
    """What the encoder sees and how it joins picture and state.

    Attributes:
        fusion: "roach" joins 1024 picture features and 256 state features in two layers to 256; "separate" brings each to 256 and joins nothing.
        state_inputs: Which components of the state are seen; the others are zero.
        state_dropout: Chance of a training pair to lose its previous action [-].
        speed_scale: Speed that is fed in as 1 [m/s].
        action_gain: Factor on the first weights of an action in the energy; 1 is plain initialisation, more bends energies sooner [-].
    """

    fusion: Literal["roach", "separate"] = "roach"
    state_inputs: tuple[StateInput, ...] = STATE_INPUTS
    state_dropout: float = 0.0
    speed_scale: float = 1.0
    action_gain: float = 1.0

    def __post_init__(self) -> None:
        known = set(self.state_inputs) <= set(STATE_INPUTS)
        _require(self, "state_inputs", known, f"names among {', '.join(STATE_INPUTS)}")
        _require_share(self, "state_dropout")
        _require_positive(self, "speed_scale", "action_gain")


@dataclasses.dataclass(frozen=True, slots=True)
class BetaConfig:
    """Loss and inference of BC-Beta; without effect on the other methods.

    Attributes:
        beta_offset: Added to both concentrations after softplus; 1 forbids densities with peaks at both ends [-].
        label_clamp: Smallest distance that labels, rescaled to [0, 1], keep from the ends [-].
        label_noise: Standard deviation of the noise on labels in training; without it labels that repeat exactly draw the concentrations to infinity [-].
        entropy_bonus: Factor on the entropy that is subtracted from the loss [-].
        inference: Which action the distribution gives.
    """

    beta_offset: Literal[0, 1] = 0
    label_clamp: float = 1e-3
    label_noise: float = 0.0
    entropy_bonus: float = 0.0
    inference: Literal["mode", "mean", "sample"] = "mode"

    def __post_init__(self) -> None:
        _require(self, "label_clamp", 0 < self.label_clamp < 0.5, "a number in (0, 0.5)")
        _require_not_negative(self, "label_noise")
        _require_not_negative(self, "entropy_bonus")


@dataclasses.dataclass(frozen=True, slots=True)
class NegativesConfig:
    """Negatives of IBC (uniform) and DA-IBC (disturbed expert actions); all but `count` is for DA-IBC alone.

    Attributes:
        count: Negatives of each training pair.
        sigma: Standard deviation of the noise on expert actions; not given in the paper [-].
        clip: Whether disturbed actions are brought back into [-1, 1]; not said in the paper.
        uniform_share: Share of the negatives that are uniform after all [-].
        pool: Which expert actions are disturbed: those of the training minibatch, or all.
        correction: "ranking" adds the log density of the negatives to the energies in training, so that they learn p(y | x); "none" is the paper's.
    """

    count: int = 256
    sigma: float = 0.22
    clip: bool = True
    uniform_share: float = 0.0
    pool: Literal["minibatch", "dataset"] = "minibatch"
    correction: Literal["none", "ranking"] = "none"

    def __post_init__(self) -> None:
        _require_positive(self, "count")
        _require_not_negative(self, "sigma")
        _require_share(self, "uniform_share")
        _require(
            self,
            "correction",
            self.correction == "none" or (self.sigma > 0 and not self.clip),
            "none, or noise of positive sigma without clip, which would pile negatives up on the edges",
        )


@dataclasses.dataclass(frozen=True, slots=True)
class DensityConfig:
    """Kernel density estimate of the expert actions, and how training evens it out.

    Attributes:
        bandwidth: Standard deviation h of the Gaussian kernel [-].
        kind: "joint" for a kernel over both action components, "product" for the product of two one-dimensional estimates.
        weighting: What 1 / KDE weighs: nothing, how often a pair is drawn, or its loss.
        exponent: Power of 1 / KDE; 1 is the paper's, smaller is milder [-].
        cap: Largest weight over the mean weight, or None for no limit [-].
    """

    bandwidth: float = 0.2
    kind: DensityKind = "joint"
    weighting: Literal["none", "sampler", "loss"] = "sampler"
    exponent: float = 1.0
    cap: float | None = None

    def __post_init__(self) -> None:
        _require_positive(self, "bandwidth")
        _require_not_negative(self, "exponent")
        _require(self, "cap", self.cap is None or self.cap >= 1, "None or a number from 1 up")


@dataclasses.dataclass(frozen=True, slots=True)
class DfoConfig:
    """Derivative-free search, Algorithm 1 of the paper.

    Attributes:
        num_samples: Candidates of each observation.
        iterations: How often the candidates are scored; one less than that they are resampled.
        sigma_init: Standard deviation of the first noise [-].
        shrink: Factor K on the noise after each resampling [-].
        start: How first candidates are drawn: expert actions by 1 / KDE (the paper's text) or by KDE (its Algorithm 1), or uniform actions.
        choice: Whether the last candidates are sampled from, or the lowest is taken.
        temper: Whether energies are divided by the iterations and noise is accepted by Metropolis, so that resampling again and again does not sharpen.
        bound: Candidates are clipped to [-bound, bound] after noise [-].
    """

    num_samples: int = 16384
    iterations: int = 5
    sigma_init: float = 0.5
    shrink: float = 0.5
    start: Literal["inverse_kde", "kde", "uniform"] = "inverse_kde"
    choice: Choice = "sample"
    temper: bool = False
    bound: float = 1.0

    def __post_init__(self) -> None:
        _require_positive(self, "num_samples", "iterations")
        _require_not_negative(self, "sigma_init")
        _require(self, "shrink", 0 < self.shrink <= 1, "a number in (0, 1]")
        _require(self, "bound", 0 < self.bound <= 1, "a number in (0, 1]")


@dataclasses.dataclass(frozen=True, slots=True)
class GridConfig:
    """Exact choice on a grid of actions.

    Attributes:
        points: Grid points along each action component; odd numbers have zero among them.
        choice: Whether the grid is sampled from, or the lowest point is taken.
        temperature: Energies are divided by it before they are sampled from; below 1 sharpens [-].
    """

    points: int = 65
    choice: Choice = "sample"
    temperature: float = 1.0

    def __post_init__(self) -> None:
        _require(self, "points", self.points >= 2, "at least 2")
        _require_positive(self, "temperature")


@dataclasses.dataclass(frozen=True, slots=True)
class SamplerConfig:
    """How IBC and DA-IBC find an action of low energy; without effect on BC-Beta.

    Attributes:
        kind: Which sampler; the settings of the other lie idle.
        dfo: Derivative-free search.
        grid: Exact choice on a grid.
        precision: Number format of the hidden layers that score candidates; "auto" takes bfloat16 where the machine is fast at it, and float32 elsewhere.
    """

    kind: Literal["dfo", "grid"] = "dfo"
    dfo: DfoConfig = DfoConfig()
    grid: GridConfig = GridConfig()
    precision: Precision = "auto"


@dataclasses.dataclass(frozen=True, slots=True)
class OptimiserConfig:
    """How the loss is descended on: Adam, with decoupled weight decay where there is any.

    Attributes:
        learning_rate: Step size, the highest one of a schedule [-].
        schedule: "constant", or "onecycle": up over the first 30 % of all steps, then down to nothing.
        epochs: Passes over the demonstrations.
        batch_size: Pairs of each step.
        weight_decay: Decoupled weight decay [-].
        gradient_clip: Largest norm of the gradient, or None for no limit [-].
        precision: Number format of the products; losses, energies and weights stay float32. "auto" takes bfloat16 where the machine is fast at it; a run that goes on keeps what it began with.
        validation_share: Share of the pairs, from the end, that are held out to report their loss [-].
        ema_decay: Decay a step of the running mean of the weights that is saved to act with; 0 saves the weights themselves [-].
    """

    learning_rate: float = 1e-5
    schedule: Literal["constant", "onecycle"] = "constant"
    epochs: int = 400
    batch_size: int = 128
    weight_decay: float = 0.0
    gradient_clip: float | None = None
    precision: Precision = "auto"
    validation_share: float = 0.0
    ema_decay: float = 0.0

    def __post_init__(self) -> None:
        _require_positive(self, "learning_rate", "epochs", "batch_size")
        _require_not_negative(self, "weight_decay")
        if self.gradient_clip is not None:
            _require_positive(self, "gradient_clip")
        _require(self, "validation_share", 0 <= self.validation_share < 1, "a share in [0, 1)")
        _require(self, "ema_decay", 0 <= self.ema_decay < 1, "a number in [0, 1)")


@dataclasses.dataclass(frozen=True, slots=True)
class LearnerConfig:
    """Everything that makes one learner what it is.

    Attributes:
        method: How it learns; IBC takes uniform negatives, DA-IBC disturbed expert actions.
        network: What the encoder sees.
        beta: Loss and inference of BC-Beta.
        negatives: Negatives of IBC and DA-IBC.
        density: Kernel density estimate and what it weighs.
        sampler: How IBC and DA-IBC choose actions.
        optimiser: How the loss is descended on.
    """

    method: Method
    network: NetworkConfig = NetworkConfig()
    beta: BetaConfig = BetaConfig()
    negatives: NegativesConfig = NegativesConfig()
    density: DensityConfig = DensityConfig()
    sampler: SamplerConfig = SamplerConfig()
    optimiser: OptimiserConfig = OptimiserConfig()

    def __post_init__(self) -> None:
        _require(self, "method", self.method in METHODS, f"one of {', '.join(METHODS)}")
