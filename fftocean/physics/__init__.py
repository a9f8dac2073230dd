"""Continuous sea state: spectra, spreadings and dispersion, without grid or random numbers."""
