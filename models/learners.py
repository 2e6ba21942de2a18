"""Which class learns by which method."""

from collections.abc import Callable

import torch

from models.bc_beta import BcBetaLearner
from models.bc_grid import BcGridLearner
from models.bc_mixture import BcMixtureLearner
from models.config import LearnerConfig, Method
from models.da_ibc import DaIbcLearner
from models.diffusion import DiffusionLearner
from models.flow import FlowLearner
from models.ibc import IbcLearner
from models.ibc_langevin import LangevinIbcLearner
from models.interfaces import Learner


def build_learner(config: LearnerConfig, *, seed: int) -> Learner:
    """Make an untrained learner.

    Args:
        config: Its settings; `config.method` names the class.
        seed: Seed of the first weights; the random numbers of the caller are left alone.

    Returns:
        The learner, on the CPU.
    """
    classes: dict[Method, Callable[[LearnerConfig], Learner]] = {
        "bc-beta": BcBetaLearner,
        "bc-mixture": BcMixtureLearner,
        "bc-grid": BcGridLearner,
        "ibc": IbcLearner,
        "da-ibc": DaIbcLearner,
        "ibc-langevin": LangevinIbcLearner,
        "diffusion": DiffusionLearner,
        "flow": FlowLearner,
    }
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        return classes[config.method](config)
