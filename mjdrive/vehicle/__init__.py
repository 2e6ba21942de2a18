"""The car: its MJCF, its numbers and what makes it move."""
