"""Ways to draw an action from an energy."""
