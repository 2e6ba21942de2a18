"""What a drive was worth: figures and plots."""
