"""mjdrive: learn multimodal driving behaviour in MuJoCo towns, without CARLA and without a GPU."""

__version__ = "0.2.0"
