"""`fftocean presets`: its tables."""


def test_presets_are_listed(run):
    code, out, err = run("presets")
    assert (code, err) == (0, "")
    for call in ("Sea.beaufort(0)", "Sea.beaufort(12)", "Sea.sea_state(9)"):
        assert call in out
