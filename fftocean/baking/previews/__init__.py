"""Previews of a bake."""
