"""Bakes for engines from end to end: refusals, encodings of normals, text beside the data."""

import json

import builders
import numpy as np
import pytest
from formulas import value_of

import fftocean as fo
from fftocean.baking import bake as baker
from fftocean.baking.cascade import bake_tiles
from fftocean.baking.finished.check import check
from fftocean.baking.finished.load import load
from fftocean.cli import main
from fftocean.errors import JobError
from fftocean.export import engines, rules
from fftocean.export.formats import FORMATS

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """Avoid integrals over the sea."""
    still = fo.measure(fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=8, size=50.0))
    monkeypatch.setattr(baker, "measure", lambda _: still)


def job(**changes):
    small = {"ocean.n": (8, 6), "ocean.size": (40.0, 25.0), "bake.frames": 4, "bake.pictures": []}
    return builders.job(small, **changes)


PAIRS = [pair for pair, cell in engines.TABLE.items() if isinstance(cell, engines.Refusal)]


@pytest.mark.parametrize(("engine", "form"), PAIRS)
def test_a_pair_that_cannot_be_writes_nothing(engine, form, tmp_path):
    order = job(bake__engine=engine, bake__format=form, bake__maps=["height"])
    words = f"engine {engine} cannot use format {form}: .*; choose format "
    for attempt in (
        lambda: fo.bake(order, tmp_path / "out"),
        lambda: bake_tiles(order, [(8, 40.0), (8, 9.0)], tmp_path / "out"),
    ):
        with pytest.raises(JobError, match=words):
            attempt()
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("more", [[], ["--dry-run"], ["--tiles", "8:40,8:9"]])
def test_the_command_line_names_the_way_out(more, tmp_path, capsys):
    flags = [
        "bake",
        "-o",
        str(tmp_path / "out"),
        "--engine",
        "godot",
        "--format",
        "png16",
        "--maps",
        "height",
        *more,
    ]
    with pytest.raises(SystemExit) as caught:
        raise SystemExit(main(flags))
    assert caught.value.code == 2
    said = capsys.readouterr()
    assert (
        "engine godot cannot use format png16: it reads PNG with 8 bits; choose format exr"
        in said.err
    )
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("normals", ["signed", "packed"])
@pytest.mark.parametrize("form", [name for name in FORMATS if 3 in FORMATS[name].channels])
def test_normals_are_read_back_from_either_encoding(form, normals, tmp_path):
    """
    To the rounding of what is stored, doubled where n = 2 c - 1; recorded in the manifest, and in
    the sidecar.

    A half has steps of 2^-11 below 1; sixteen bits have steps of 2/65535 over -1..1.
    """
    order = job(bake__format=form, bake__normals=normals, bake__maps=["normal"])
    manifest = fo.bake(order, tmp_path)
    assert check(tmp_path) == ()
    encoding = "packed: n = 2 c - 1" if normals == "packed" else "signed: n = c"
    assert manifest["conventions"]["normals"] == encoding
    if sidecar := FORMATS[form].sidecar:
        text = json.loads((tmp_path / sidecar.format(stem="normal")).read_text())
        assert text.get("attributes", text)["conventions"]["normals"] == encoding
    frame = order.ocean().loop_frame(3, 4, ("normal",))
    step = {
        "float16": 2.0**-12,
        "float32": 2.0**-25,
        "uint16": 0.5 / 65535 if normals == "packed" else 0.5 / 32767,
    }
    allowed = step[FORMATS[form].stored] * (2 if normals == "packed" else 1) + 2.0**-22
    assert np.max(np.abs(load(tmp_path)["normal"][3] - frame.normal)) <= allowed


def test_the_encoding_is_the_engines_own_unless_it_is_chosen(tmp_path):
    for engine, normals, encoding in (
        ("godot", "engine", "packed"),
        ("godot", "signed", "signed"),
        ("canonical", "engine", "signed"),
        ("canonical", "packed", "packed"),
    ):
        order = job(
            bake__engine=engine,
            bake__format="bin",
            bake__normals=normals,
            bake__maps=["normal"],
            sea__wind__speed=0.0,
        )
        folder = tmp_path / f"{engine}-{normals}"
        assert fo.bake(order, folder)["conventions"]["normals"].startswith(encoding)
        texel = np.fromfile(folder / "normal.bin", "<f2")[:3]
        assert texel.tolist() == ([0.5, 0.5, 1.0] if encoding == "packed" else [0.0, 0.0, 1.0])
        assert np.all(load(folder)["normal"] == [0.0, 0.0, 1.0])


def test_a_bake_of_an_older_version_is_read_as_it_was_written():
    """
    Its manifest's words on rows and normals count; normals were signed before there was a choice.
    """
    from fftocean.export.profiles import recorded

    now = engines.profile_for("babylon", "exr")
    old = {"rows": "row 0 of a file is the south edge; the loader puts it at v = 0"}
    then = recorded(now, old)
    assert (then.first_row, then.normals) == ("south", "signed")
    assert recorded(now, rules.conventions(now)) == now


@pytest.mark.parametrize("engine", ["godot", "unreal", "babylon", "three"])
def test_the_manifest_says_what_a_sidecar_says(engine, tmp_path):
    """
    For formats without one: rule, numbers, meaning of the channels; of a part of the loop, its own
    start and length.
    """
    order = job(bake__engine=engine, bake__maps=["displacement"])
    fo.bake(order.replaced({"bake.format": "bin"}), tmp_path / "bin", frames="1:4:2")
    side = json.loads((tmp_path / "bin/displacement.json").read_text())
    for form in ("bin", "exr"):
        folder = tmp_path / form
        manifest = fo.bake(order.replaced({"bake.format": form}), folder, frames="1:4:2")
        profile = engines.profile_for(engine, form)
        assert manifest["sampling"]["values"] == side["sampling"]["values"]
        assert manifest["maps"]["displacement"]["world"] == side["world"]
        assert manifest["sampling"]["u"] == rules.sampling(profile)["u"]
        assert f"v = {manifest['sampling']['v']}, repeated" in manifest["conventions"]["samples"]
    assert (side["start"], side["loop"], side["closes"], side["frames"]) == (4.0, 16.0, True, 2)
    bounds = manifest["extremes"]
    scale = 100.0 if engine == "unreal" else 1.0
    assert side["bounds"]["vertical"] == pytest.approx(scale * bounds["max_height"])
    assert side["bounds"]["horizontal"] == pytest.approx(scale * bounds["max_horizontal"])


def test_a_part_that_does_not_close_says_so(tmp_path):
    order = job(bake__format="bin", bake__maps=["height"])
    fo.bake(order, tmp_path, frames="0:2")
    side = json.loads((tmp_path / "height.json").read_text())
    assert (side["closes"], side["loop"], side["frames_per_second"]) == (False, 8.0, 0.25)


@pytest.mark.parametrize("engine", ["canonical", "godot", "unreal"])
def test_cascade_json_finds_the_sea(engine, tmp_path):
    """
    Its rule for u and v, evaluated for points that are samples of both tiles; heights added: the
    direct sum of all waves.

    Halves round heights below 4 m by at most 1 mm each.
    """
    order = job(bake__engine=engine, bake__format="bin", bake__maps=["height"])
    tiles = [(16, 32.0), (16, 8.0)]
    listed = bake_tiles(order, tiles, tmp_path)
    assert listed["sampling"] == json.loads((tmp_path / "cascade.json").read_text())["sampling"]
    rule = listed["sampling"]
    scale = 100.0 if rule["unit"] == "cm" else 1.0
    axes = {name: points for name, points in rule["axes"].items() if points != "up"}
    x, y = (
        at.ravel() for at in np.meshgrid(np.arange(-8.0, 40.0, 2.0), np.arange(-8.0, 40.0, 2.0))
    )
    ours = {"east": x, "north": y, "south": -y}
    total = np.zeros(x.shape)
    for tile in listed["tiles"]:
        names = {
            key: value_of(rule[key], {"n": tile["n"], "size": tile["size"]})
            for key in ("nx", "ny", "size_x", "size_y")
        }
        names |= {name: scale * ours[points] for name, points in axes.items()}
        column = np.rint(value_of(rule["u"], names) * names["nx"] - 0.5).astype(int) % names["nx"]
        row = np.rint(value_of(rule["v"], names) * names["ny"] - 0.5).astype(int) % names["ny"]
        texture = np.fromfile(tmp_path / tile["path"] / "height.bin", "<f2").reshape(
            -1, names["ny"], names["nx"], 4
        )
        total += texture[0, row, column, 0].astype(float) / scale
    cascade = fo.Cascade(order.sea(), tiles, seed=order.settings["ocean.seed"], loop=16.0)
    expected = fo.gerstner.surface(cascade, x, y, 0.0).z
    assert np.std(expected) > 0.05
    assert np.max(np.abs(total - expected)) < 2e-3
    assert np.corrcoef(total, expected)[0, 1] > 0.999
