"""Folder of a bake: layout, lock, journal, identity."""
