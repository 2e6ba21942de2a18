"""Results as pictures, one figure a file."""
