"""The bird's-eye view that policies see."""
