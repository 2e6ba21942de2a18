"""Refuses settings without a meaning, by name."""

from models.errors import SettingError


def require(config: object, name: str, condition: bool, expected: str) -> None:
    """Refuse a setting with what it is and what was expected.

    Raises:
        SettingError: If the condition does not hold.
    """
    if not condition:
        raise SettingError(f"{name} is {getattr(config, name)!r}; expected {expected}.")


def require_positive(config: object, *names: str) -> None:
    """Refuse settings that are not positive."""
    for name in names:
        require(config, name, getattr(config, name) > 0, "a positive number")


def require_not_negative(config: object, name: str) -> None:
    """Refuse a setting below zero."""
    require(config, name, getattr(config, name) >= 0, "zero or a positive number")


def require_share(config: object, name: str) -> None:
    """Refuse a setting that is no share."""
    require(config, name, 0 <= getattr(config, name) <= 1, "a share in [0, 1]")
