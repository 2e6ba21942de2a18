"""A town of the package."""

from pathlib import Path

FOLDER = Path(__file__).parent / "towns" / "example-town"
"""Holds map.xodr and town.json."""
