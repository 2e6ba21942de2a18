"""Frozen settings, and how they are written to and read from JSON."""

from mjdrive.config.cameras import CameraConfig
from mjdrive.config.collecting import CollectConfig, DisturbanceConfig, ExpertName
from mjdrive.config.driving_env import EnvConfig, InfractionName, RewardConfig
from mjdrive.config.json_files import from_dict, read_json, require, to_json, write_json
from mjdrive.config.mpc import MpcConfig
from mjdrive.config.settings import (
    BevConfig,
    ExtraLayer,
    PidConfig,
    RulesConfig,
    SimulationConfig,
)
from mjdrive.config.study import Arm, Demonstrations, Draws, Reference, StudyConfig, Variant
from mjdrive.config.tuning import TuneConfig

__all__ = [
    "Arm",
    "BevConfig",
    "CameraConfig",
    "CollectConfig",
    "Demonstrations",
    "DisturbanceConfig",
    "Draws",
    "EnvConfig",
    "ExpertName",
    "ExtraLayer",
    "InfractionName",
    "MpcConfig",
    "PidConfig",
    "Reference",
    "RewardConfig",
    "RulesConfig",
    "SimulationConfig",
    "StudyConfig",
    "TuneConfig",
    "Variant",
    "from_dict",
    "read_json",
    "require",
    "to_json",
    "write_json",
]
