"""One page that shows all of it."""
