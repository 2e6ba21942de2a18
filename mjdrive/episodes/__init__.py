"""Drives as data: how they are made and kept."""
