"""Arrays inside the nouns are read-only."""

from dataclasses import fields

import numpy as np


def freeze_arrays(instance: object) -> None:
    """Make read-only copies of the array fields of a frozen dataclass."""
    for field in fields(instance):  # type: ignore[arg-type]
        value = getattr(instance, field.name)
        if isinstance(value, np.ndarray) and value.flags.writeable:
            frozen = value.copy()
            frozen.flags.writeable = False
            object.__setattr__(instance, field.name, frozen)
