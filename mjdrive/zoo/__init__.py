"""Policies that come with mjdrive: how they are found, what their cards say, and how they are made of training runs."""
