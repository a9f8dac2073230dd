"""The continuous sea: no grid, no FFT, no chance."""
