"""What is compared: named studies, their ablations, changes to them, and the agents that follow."""
