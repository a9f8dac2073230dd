"""`fftocean check`: its words and exit codes; tests/baking has its findings."""

from command_line import events


def test_a_sound_bake_has_no_problems(run, baked):
    assert run("check", baked) == (0, "no problems found: out\n", "")
    assert run("check", baked, "--quiet") == (0, "", "")
    code, out, err = run("check", baked, "--json")
    assert (code, events(out), err) == (0, [{"event": "done", "findings": 0}], "")


def test_problems_are_listed_and_repaired(run, baked):
    expected = {p: p.read_bytes() for p in baked.rglob("*") if p.is_file()}
    (baked / "height/0001.exr").write_bytes(b"")
    (baked / "height/0002.exr").unlink()
    code, out, err = run("check", baked)
    assert (code, err) == (5, "")
    assert "cut" in out
    assert "height/0001.exr" in out
    assert out.endswith("2 problems: out\n")
    code, out, _ = run("check", baked, "--json")
    assert code == 5
    found = events(out)
    assert [e["event"] for e in found] == ["finding", "finding", "done"]
    assert {(e["kind"], e["path"], e["map"], e["frame"]) for e in found[:2]} == {
        ("cut", "height/0001.exr", "height", 1),
        ("missing", "height/0002.exr", "height", 2),
    }
    code, out, _ = run("check", baked, "--repair")
    assert code == 0
    assert "repaired: 2 frames written again" in out
    assert out.endswith("no problems found: out\n")
    assert {p: p.read_bytes() for p in baked.rglob("*") if p.is_file()} == expected


def test_an_unfinished_bake_exits_5_and_an_absent_folder_4(run, baked):
    (baked / "manifest.json").unlink()
    code, out, _ = run("check", baked)
    assert code == 5
    assert "unfinished" in out
    code, out, err = run("check", "nowhere")
    assert (code, out) == (4, "")
    assert err == "fftocean: nowhere must be the folder of a bake, and does not exist\n"
