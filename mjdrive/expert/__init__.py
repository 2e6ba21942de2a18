"""Drivers that know the route and the truth."""
