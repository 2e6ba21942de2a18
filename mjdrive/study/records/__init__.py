"""What a study keeps: its folder, its results, and what they are measured from."""
