"""Towns drawn from compact street plans, written by hand or out of a seed."""
