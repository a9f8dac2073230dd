"""`fftocean verify`: its refusals; tests/test_proof.py has its checks."""

import pytest
from command_line import refusal


@pytest.mark.parametrize("t", ["nan", "inf", "1e13"])
def test_times_out_of_range_are_refused(run, t):
    assert f"t must be between -1e+12 and 1e+12 s, got {float(t)}" in refusal(
        run("verify", "--n", "8", "--t", t)
    )
