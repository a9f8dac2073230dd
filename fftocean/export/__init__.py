"""Encoding of arrays in files, the only place where they are scaled and converted."""
