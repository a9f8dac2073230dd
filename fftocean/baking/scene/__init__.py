"""Rendering of one frame of a job to map files."""
