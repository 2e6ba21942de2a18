"""What the encoder sees."""

import dataclasses
from typing import Literal, get_args

from models.config.checks import require, require_positive, require_share

StateInput = Literal["speed", "previous_acceleration", "previous_steering"]

STATE_INPUTS: tuple[StateInput, ...] = get_args(StateInput)


@dataclasses.dataclass(frozen=True, slots=True)
class NetworkConfig:
    """What the encoder sees and how it joins picture and state.

    Attributes:
        fusion: "roach" joins 1024 picture features and 256 state features in two layers to 256; "separate" brings each to 256 and joins nothing.
        light_history: Whether the lights of 0.8 s and 1.5 s ago are seen; if not, their channels show those of now once more.
        state_inputs: Which components of the state are seen; the others are zero.
        state_dropout: Chance of a training pair to lose its previous action [-].
        speed_scale: Speed that is fed in as 1 [m/s].
        action_gain: Factor on the first weights of an action in the energy; 1 is plain initialisation, more bends energies sooner [-].
    """

    fusion: Literal["roach", "separate"] = "roach"
    light_history: bool = True
    state_inputs: tuple[StateInput, ...] = STATE_INPUTS
    state_dropout: float = 0.0
    speed_scale: float = 1.0
    action_gain: float = 1.0

    def __post_init__(self) -> None:
        known = set(self.state_inputs) <= set(STATE_INPUTS)
        require(self, "state_inputs", known, f"names among {', '.join(STATE_INPUTS)}")
        require_share(self, "state_dropout")
        require_positive(self, "speed_scale", "action_gain")
