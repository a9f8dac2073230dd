"""Workers that write the frames of a bake."""
