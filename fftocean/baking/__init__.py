"""Baking of a job into a folder of maps that can be trusted."""
