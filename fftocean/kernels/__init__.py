"""
Compiled loops over bare arrays: no classes, no checks, no allocation. The caller guarantees shape,
dtype and order.
"""
