"""What can go wrong for the user of the networks: what was given, what was expected and what to do."""


class ModelsError(ValueError):
    """A mistake that the user can mend."""


class SettingError(ModelsError):
    """A setting out of its range, of the wrong type, or unknown."""


class CheckpointError(ModelsError):
    """A run folder that is missing, truncated, or does not fit what is asked of it."""


class TrainingError(ModelsError):
    """Demonstrations or settings with which no training can go on."""


class HardwareError(ModelsError):
    """A device or a number of processes that this machine does not give."""
