"""Fits the settings of an expert to a car, and says on what evidence."""
