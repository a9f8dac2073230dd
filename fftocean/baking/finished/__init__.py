"""Contents of a finished bake: manifest, files, check, loading."""
