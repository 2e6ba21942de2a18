"""The whole study in one command: demonstrations, trained agents, what they are worth, and the tables of it."""
