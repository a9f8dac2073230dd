"""`fftocean verify`: its refusals; tests/test_proof.py has its checks."""

import pytest
from command_line import refusal

from fftocean.proof import Check


@pytest.mark.parametrize("t", ["nan", "inf", "1e13"])
def test_times_out_of_range_are_refused(run, t):
    assert f"t must be between -1e+12 and 1e+12 s, got {float(t)}" in refusal(
        run("verify", "--n", "8", "--t", t)
    )


def some_checks(*failing):
    """Return three checks, of which some have an error above the tolerance."""
    names = ("height", "seam", "loop")
    return tuple(Check(n, "direct sum", 1.0 if n in failing else 0.0, 0.5, "why") for n in names)


@pytest.mark.parametrize("failing", [(), ("seam",), ("height", "loop")])
def test_a_failed_check_is_named_and_leaves_with_5(run, failing, monkeypatch):
    monkeypatch.setattr("fftocean.proof.verify", lambda *_: some_checks(*failing))
    code, out, _ = run("verify", "--n", "8")
    assert code == (5 if failing else 0)
    assert out.count("FAILED") == len(failing)
    assert out.count(" ok ") == 3 - len(failing)
    said = f"{3 - len(failing)} of 3 checks passed"
    assert out.endswith(f"{said}; failed: {', '.join(failing)}\n" if failing else f"{said}\n")


def test_time_and_precision_are_those_asked_for(run, monkeypatch):
    """Double precision if not told otherwise."""
    seen = []
    monkeypatch.setattr(
        "fftocean.proof.verify", lambda ocean, t: seen.append((ocean.dtype, t)) or some_checks()
    )
    assert "8 x 8, float64, t = 3.7 s" in run("verify", "--n", "8")[1]
    assert (
        "8 x 8, float32, t = 2 s" in run("verify", "--n", "8", "--t", "2", "--dtype", "Float32")[1]
    )
    assert [(str(dtype), t) for dtype, t in seen] == [("float64", 3.7), ("float32", 2.0)]
