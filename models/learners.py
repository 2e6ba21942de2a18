"""Which class learns by which method."""

import torch

from models.bc_beta import BcBetaLearner
from models.config import LearnerConfig
from models.da_ibc import DaIbcLearner
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
    classes: dict[str, type[BcBetaLearner] | type[IbcLearner]] = {
        "bc-beta": BcBetaLearner,
        "ibc": IbcLearner,
        "da-ibc": DaIbcLearner,
        "ibc-langevin": LangevinIbcLearner,
    }
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        return classes[config.method](config)
