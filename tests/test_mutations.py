"""The table of deliberate errors: each can still be made. `tools/mutate.py` makes them."""

import mutate


def test_every_error_can_be_made():
    """Its text is in its module once, the new one compiles, and its tests exist."""
    assert mutate.faults(mutate.read_table()) == []


def test_there_is_an_error_of_each_kind():
    table = mutate.read_table()
    assert {m.kind for m in table} == set(mutate.KINDS)
    assert all(m.why for m in table)
    assert sum(not m.equivalent for m in table) >= 150
