"""`fftocean keys`: every key and kind, and the search for one."""

from fftocean.job.parameters import PARAMETERS
from fftocean.physics.spectra import SPECTRA
from fftocean.physics.spreading import SPREADINGS


def test_every_key_and_every_kind_is_listed(run):
    code, out, err = run("keys")
    assert (code, err) == (0, "")
    lines = out.splitlines()
    for parameter in PARAMETERS:
        assert any(line.startswith(f"{parameter.key} = ") for line in lines), parameter.key
    for role, kinds in (("spectrum", SPECTRA), ("spreading", SPREADINGS)):
        for name in kinds:
            assert any(line.split()[:2] == [role, name] for line in lines), name


def test_a_pattern_selects(run):
    code, out, _ = run("keys", "FOAM.tau")
    assert code == 0
    assert out.splitlines()[0].startswith("bake.foam.tau = 3.5")
    assert len(out.splitlines()) == 2
    _, out, _ = run("keys", "ochi")
    assert "{hs, [member]}" in out.replace("[member], ", "[member]") or "member" in out


def test_a_pattern_without_a_match_is_refused(run):
    assert run("keys", "zzz") == (
        2,
        "",
        "fftocean: no key and no kind contains 'zzz'; `fftocean keys` lists them all\n",
    )
