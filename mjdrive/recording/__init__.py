"""Drives to look at again: the states of an episode brought back, and videos of them."""
