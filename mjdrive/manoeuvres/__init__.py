"""Standard manoeuvres: what the car can do, measured and held against bars, and beside other models."""
