"""mjdrive: learn multimodal driving behaviour in MuJoCo towns, without CARLA and without a GPU."""

from mjdrive import gymnasium_ids

__version__ = "0.2.0"

gymnasium_ids.offer()
