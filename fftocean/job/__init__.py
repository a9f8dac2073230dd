"""Job of a bake: the sea, the tile and what to write."""
