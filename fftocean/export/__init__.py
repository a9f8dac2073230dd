"""Arrays to files. Scaling and conversion happen here and nowhere else."""
