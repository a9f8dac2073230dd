"""Files of waves for programs that compute loads on structures; public as `fftocean.export`."""
