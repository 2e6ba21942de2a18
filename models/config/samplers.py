"""How actions of low energy are found."""

import dataclasses
from typing import Literal

from models.config.checks import require, require_not_negative, require_positive
from models.config.langevin import LangevinConfig, Start

Choice = Literal["sample", "argmin"]
Precision = Literal["auto", "float32", "bfloat16"]
Undo = Literal["none", "negatives", "density", "both"]


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
    start: Start = "inverse_kde"
    choice: Choice = "sample"
    temper: bool = False
    bound: float = 1.0

    def __post_init__(self) -> None:
        require_positive(self, "num_samples", "iterations")
        require_not_negative(self, "sigma_init")
        require(self, "shrink", 0 < self.shrink <= 1, "a number in (0, 1]")
        require(self, "bound", 0 < self.bound <= 1, "a number in (0, 1]")


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
        require(self, "points", self.points >= 2, "at least 2")
        require_positive(self, "temperature")


@dataclasses.dataclass(frozen=True, slots=True)
class SamplerConfig:
    """How energy models find an action of low energy; without effect on the other methods.

    Attributes:
        kind: Which sampler; the settings of the others lie idle.
        dfo: Derivative-free search.
        grid: Exact choice on a grid.
        langevin: Chains that walk down the energy.
        undo: What training tilted and acting takes out again: the density of the "negatives", that of 1 / KDE weights ("density"), or "both".
        precision: Number format of the hidden layers that score candidates; "auto" takes float32 for a grid on a CPU, else bfloat16 where the machine is fast at it, and float32 elsewhere.
    """

    kind: Literal["dfo", "grid", "langevin"] = "dfo"
    dfo: DfoConfig = DfoConfig()
    grid: GridConfig = GridConfig()
    langevin: LangevinConfig = dataclasses.field(default_factory=LangevinConfig)
    undo: Undo = "none"
    precision: Precision = "auto"
