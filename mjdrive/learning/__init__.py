"""Where episodes meet networks; the only room that imports torch and models."""
