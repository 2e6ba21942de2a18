"""Drives for other people: exported to their formats, and taken over from them."""
