"""`fftocean presets`: its tables."""


def test_presets_are_listed(run):
    code, out, err = run("presets")
    assert (code, err) == (0, "")
    for call in ("Sea.beaufort(0)", "Sea.beaufort(12)", "Sea.sea_state(9)"):
        assert call in out


def rows(out, call):
    """Return number and figures of each row of a table: U10, knots, Hs, Hs computed, Tp."""
    lines = [line for line in out.splitlines() if line.startswith(f"Sea.{call}(")]
    found = {}
    for line in lines:
        words = line.split()
        found[int(words[0].split("(")[1].rstrip(")"))] = [float(word) for word in words[-5:]]
    return found


def test_both_tables_have_their_figures(run):
    """
    Beaufort 6 is 22 to 27 knots with waves of 3 m, sea state 5 has waves of 2.5 to 4 m (WMO, code
    tables 1100 and 3700); a knot is 1852 m an hour.
    """
    out = run("presets")[1]
    winds, states = rows(out, "beaufort"), rows(out, "sea_state")
    assert sorted(winds) == list(range(13))
    assert sorted(states) == list(range(10))
    assert 22.0 <= winds[6][1] <= 27.0
    assert winds[6][2] == 3.0
    assert states[5][2] == (2.5 + 4.0) / 2.0
    for speed, knots, hs, computed, _ in (*winds.values(), *states.values()):
        assert abs(speed * 3600.0 / 1852.0 - knots) <= 0.6  # 0.05 m/s, and half a knot
        assert abs(hs - computed) <= 1e-3
    headings = next(line for line in out.splitlines() if line.startswith("call"))
    assert headings.split() == [
        "call",
        "name",
        "U10",
        "m/s",
        "knots",
        "Hs",
        "m",
        "computed",
        "m",
        "Tp",
        "s",
    ]
