"""What takes time, a job at a time: demonstrations, training, drives, moments lived again, questions to densities."""
