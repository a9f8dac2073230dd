"""
Compiled loops over arrays, without checks and allocation.

The caller guarantees shape, dtype and memory order.
"""
