"""Packages with an engine's kernels, and its project beside them."""

import hashlib
import json
import os
import re
import shutil
from dataclasses import replace
from pathlib import Path

import builders_of_packages as build
import pytest

import fftocean as fo
from fftocean import engine_projects, example_projects, runtime
from fftocean.engine_projects import ENGINES
from fftocean.errors import OutputError
from fftocean.fields import EIGHT
from fftocean.runtime import shaders
from fftocean.runtime.folder import edited_files

INSTALLED = [
    name
    for name, engine in ENGINES.items()
    if any((place / engine.project).is_dir() for place in example_projects.PLACES)
]


@pytest.fixture
def toy(tmp_path, monkeypatch):
    """Put a small project of two files and a README in the place of Unity's."""
    place = tmp_path / "examples"
    (place / "unity" / "inner").mkdir(parents=True)
    (place / "unity" / "README.md").write_text("steps")
    (place / "unity" / "Main.cs").write_text("class Main {}")
    (place / "unity" / "inner" / "Deep.cs").write_text("class Deep {}")
    shutil.copytree(example_projects.PLACES[1] / "readers", place / "readers")
    monkeypatch.setattr(example_projects, "PLACES", (place,))
    return place / "unity"


def ocean(amplitude=0.1):
    """Return an ocean of two waves, which is soon exported."""
    waves = [(1, 0, amplitude, 0.0), (-1, 2, 0.05, 1.0)]
    return fo.Ocean.from_modes(waves, n=8, size=50.0, loop=20.0)


def test_every_engine_has_its_project():
    assert list(ENGINES) == INSTALLED


@pytest.mark.parametrize("name", INSTALLED)
def test_an_engine_gets_its_kernels_and_its_project(name, tmp_path):
    """
    The kernels are of the package, with their checksums; the project is beside it; the package is
    read and checked as without it, and a second export has the same bytes.
    """
    engine = ENGINES[name]
    document = fo.export_sea(build.cascade(), tmp_path / "one", engine=name)
    found = build.tree(tmp_path / "one")
    listed = {row["name"]: row for row in document["files"]}
    kernels = {}
    for language in engine.languages:
        kernels |= shaders.files(language)
    endings = dict(engine.renamed)
    for file, data in kernels.items():
        ending = Path(file).suffix
        copied = Path(file).stem + endings.get(ending, ending)
        assert found[copied] == data
        assert listed[copied]["sha256"] == hashlib.sha256(data).hexdigest()
    assert "twiddle.bin" in listed
    project = document["project"]
    assert project["engine"] == name
    beside = {row["name"]: row for row in project["files"]}
    assert set(found) == set(listed) | set(beside) | {"sea.json"}
    assert not set(listed) & set(beside)
    for file, row in beside.items():
        assert row["sha256"] == hashlib.sha256(found[file]).hexdigest()
    assert set(engine.readers) <= set(beside)
    assert fo.check(tmp_path / "one") == ()
    loaded = fo.load_sea(tmp_path / "one")
    plain = runtime.ocean_of(runtime.pack(build.cascade(), reference=False))
    for one, other in zip(loaded.loop_frame(3, 8), plain.loop_frame(3, 8), strict=True):
        assert all((one[field] == other[field]).all() for field in EIGHT)
    fo.export_sea(build.cascade(), tmp_path / "two", engine=name)
    assert build.tree(tmp_path / "two") == found


@pytest.mark.parametrize("name", ["unity", "unreal", "bevy"])
def test_a_project_that_was_not_run_says_so_first(name, tmp_path):
    fo.export_sea(ocean(), tmp_path, engine=name)
    project = tmp_path / ENGINES[name].readme
    assert re.match(r"> Not run in \w+: ", project.read_text())
    main = {"unity": "SeaSurface.cs", "unreal": "Sea.usf", "bevy": "src/main.rs"}[name]
    assert re.match(r"// Not run in \w+: ", (tmp_path / main).read_text())
    steps = re.findall(r"^(\d+)\. ", project.read_text(), re.MULTILINE)
    assert steps == [str(i) for i in range(1, 11)]


LIMITS = {
    # the kernels' lines; bytes of a tile's table; a place in the block
    "unity": {"SeaPackage.cs": {"512", "64"}, "SeaSurface.cs": {"32"}},
    "unreal": {"Source/FFTOcean/Private/SeaLayout.h": {"512", "64"}, "Sea.usf": {"64"}}
    # bytes of a tile's table; groups of 32 x 32 texels
    | {"Source/FFTOcean/Private/SeaKernels.cpp": {"64", "32"}},
    "bevy": {"src/layout.rs": {"512", "64"}, "src/kernels.rs": {"32"}},
}
"""Powers of two in a project that are no sizes of a package."""


@pytest.mark.parametrize("name", LIMITS)
def test_no_project_has_a_size_of_a_package(name):
    """Its own code has no number that a tile could have samples of, but for limits and layouts."""
    engine = ENGINES[name]
    for file, path in example_projects.project_files(engine.project).items():
        if file.endswith((".md", ".toml", ".uplugin", ".asmdef")):
            continue
        code = re.sub(r"//[^\n]*|\"[^\"\n]*\"", "", path.read_text(encoding="utf-8"))
        # `1 << 8` cells of foam are a setting
        numbers = set(re.findall(r"(?<![\w.])(?:32|64|128|256|512|1024)(?![\w.]|u8|f)", code))
        assert numbers <= LIMITS[name].get(file, set()), (file, numbers)
        assert not re.search(r"\btile[0-9]\b", code), file


@pytest.mark.parametrize("name", list(ENGINES))
def test_lines_that_are_too_long_for_the_kernels_are_refused(name, tmp_path):
    wide = fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=(1024, 2), size=50.0, loop=20.0)
    if ENGINES[name].languages:
        with pytest.raises(
            fo.ParameterError,
            match=f"n of tile 0 must be a power of two of at most 512 for engine {name}, since the "
            "kernels keep a line in 16 KiB .*; got 1024",
        ):
            fo.export_sea(wide, tmp_path / "sea", engine=name)
        assert not (tmp_path / "sea").exists()
    else:
        assert ENGINES[name].most_side == 1024
        runtime.pack(wide, engine=name, reference=False)


def test_bad_seas_are_refused_as_without_an_engine(tmp_path):
    """By the rule, and with a loop that would do, with the error of its frequencies."""
    never = fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=50.0)
    with pytest.raises(fo.ParameterError, match=r"such as loop=.*, whose frequencies are off by"):
        fo.export_sea(never, tmp_path / "sea", engine="godot")
    odd = fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=100, size=50.0, loop=20.0)
    with pytest.raises(fo.ParameterError, match=r"must be a power of two .*; the next one is 128"):
        fo.export_sea(odd, tmp_path / "sea", engine="godot")
    long = fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=1.0, loop=1e5)
    with pytest.raises(fo.ParameterError, match="at most 65535 cycles in a loop"):
        fo.export_sea(long, tmp_path / "sea", engine="godot")
    with pytest.raises(fo.ParameterError, match="engine must be one of unity"):
        fo.export_sea(ocean(), tmp_path / "sea", engine="quake")
    assert not (tmp_path / "sea").exists()


def test_a_users_changes_to_a_project_are_no_damage_and_are_kept(toy, tmp_path):
    """Edited, moved, removed or added; and another sea, or a newer project, leaves them alone."""
    out = tmp_path / "sea"
    document = fo.export_sea(ocean(), out, engine="unity")
    assert edited_files(out, document) == []
    (out / "Main.cs").write_text("class Mine {}")
    (out / "inner" / "Deep.cs").rename(out / "inner" / "Moved.cs")
    (out / "Main.cs.meta").write_text("of the engine")
    (out / "Library").mkdir()
    assert fo.check(out) == ()
    assert isinstance(fo.load_sea(out), fo.Ocean)
    assert edited_files(out, document) == ["Main.cs", "inner/Deep.cs"]
    (toy / "README.md").write_text("newer steps")
    with pytest.raises(OutputError, match="holds another sea"):
        fo.export_sea(ocean(0.2), out, engine="unity")
    fo.export_sea(ocean(0.2), out, engine="unity", overwrite=True)
    assert (out / "Main.cs").read_text() == "class Mine {}"
    assert (out / "README.unity.md").read_text() == "newer steps"
    assert (out / "inner" / "Deep.cs").read_text() == "class Deep {}"
    assert (out / "inner" / "Moved.cs").is_file()
    assert fo.check(out) == ()


@pytest.mark.usefixtures("toy")
def test_a_project_leaves_with_its_engine_but_for_edited_files(tmp_path):
    out = tmp_path / "sea"
    fo.export_sea(ocean(), out, engine="unity")
    (out / "Main.cs").write_text("class Mine {}")
    fo.export_sea(ocean(), out, overwrite=True)
    assert set(build.tree(out)) == {"Main.cs", "README.md", "check.json", "sea.json", "tile0.waves"}
    (found,) = fo.check(out)
    assert (found.kind, found.path) == ("extra", "Main.cs")


@pytest.mark.usefixtures("toy")
def test_a_file_in_the_place_of_a_project_is_never_replaced(tmp_path):
    out = tmp_path / "sea"
    (out / "inner").mkdir(parents=True)
    (out / "inner" / "Deep.cs").write_text("mine")
    for overwrite in (False, True):
        with pytest.raises(OutputError, match=r"holds inner/Deep\.cs, which is not listed"):
            fo.export_sea(ocean(), out, engine="unity", overwrite=overwrite)
    assert build.tree(out) == {"inner/Deep.cs": b"mine"}


@pytest.mark.usefixtures("toy")
def test_damage_to_the_package_is_found_beside_a_project(tmp_path):
    out = tmp_path / "sea"
    fo.export_sea(ocean(), out, engine="unity")
    (out / "fftocean.hlsl").write_text("mine")
    (out / "tile7.waves").write_bytes(b"")
    kinds = {(found.kind, found.path) for found in fo.check(out)}
    assert kinds == {("cut", "fftocean.hlsl"), ("extra", "tile7.waves")}


class Stopped(BaseException):
    """A stop that nothing catches."""


@pytest.mark.usefixtures("toy")
@pytest.mark.parametrize("earlier", [False, True])
def test_an_export_that_was_stopped_is_finished_by_the_same_call(earlier, tmp_path, monkeypatch):
    """
    After the n-th flush to the disk, for every n: there is no manifest of a sea that is not whole.

    With an earlier sea in the folder, one of whose files was edited, the edit is kept.
    """
    fo.export_sea(ocean(0.2), tmp_path / "calm", engine="unity")
    expected = build.tree(tmp_path / "calm")
    if earlier:
        expected["Main.cs"] = b"class Mine {}"
    real = os.fsync
    for n in range(1, 40):
        out, calls = tmp_path / f"out{n}", []
        if earlier:
            fo.export_sea(ocean(), out, engine="unity")
            (out / "Main.cs").write_text("class Mine {}")

        def stop(descriptor, calls=calls, n=n):
            real(descriptor)
            calls.append(descriptor)
            if len(calls) == n:
                raise Stopped

        with monkeypatch.context() as patch:
            patch.setattr(os, "fsync", stop)
            try:
                fo.export_sea(ocean(0.2), out, engine="unity", overwrite=earlier)
                break
            except Stopped:
                pass
        if build.tree(out) != expected:
            with pytest.raises(fo.IntegrityError):
                fo.load_sea(out)
            fo.export_sea(ocean(0.2), out, engine="unity", overwrite=earlier)
        assert build.tree(out) == expected
        assert not [name for name in expected if name.endswith(".tmp")]
    assert n > 6


@pytest.mark.usefixtures("toy")
def test_a_link_in_the_place_of_a_projects_folder_leads_nowhere(tmp_path):
    outside, out = tmp_path / "outside", tmp_path / "sea"
    outside.mkdir()
    out.mkdir()
    (out / "inner").symlink_to(outside)
    with pytest.raises(OutputError, match="is a link"):
        fo.export_sea(ocean(), out, engine="unity")
    assert not list(outside.iterdir())


@pytest.mark.parametrize("name", ["../out.cs", "/etc/x", "a/../b", "a//b", ".hidden/x", "sea.json"])
def test_a_document_cannot_list_a_project_outside_its_folder(name):
    package = build.changed(["version"], 1)
    package.document["project"] = {"engine": "unity", "files": [{"name": name}]}
    with pytest.raises(fo.IntegrityError, match=r"project.files\[0\].name must be that of a file"):
        runtime.ocean_of(package)


def test_a_project_with_a_file_of_the_package_is_refused(toy, tmp_path):
    (toy / "fftocean.hlsl").write_text("other kernels")
    with pytest.raises(OutputError, match=r"engine unity has a file fftocean\.hlsl of the package"):
        fo.export_sea(ocean(), tmp_path / "sea", engine="unity")


@pytest.mark.parametrize("name", ["sea.json", "a b.cs", "con.cs", "inner/aux", "é.cs"])
def test_a_project_with_a_name_that_no_document_can_list_is_refused(name, toy, tmp_path):
    """A document's own name, and names that some system cannot have."""
    (toy / name).write_text("x")
    with pytest.raises(OutputError, match=f"the project of engine unity cannot have a file {name}"):
        fo.export_sea(ocean(), tmp_path / "sea", engine="unity")
    assert not list((tmp_path / "sea").glob("*.cs"))


@pytest.mark.usefixtures("toy")
def test_an_engine_whose_project_is_not_installed_is_named(tmp_path):
    with pytest.raises(OutputError, match="example project bevy are not installed"):
        fo.export_sea(ocean(), tmp_path / "sea", engine="bevy")


def test_textures_that_an_engine_needs_come_with_it(monkeypatch):
    needy = replace(ENGINES["unity"], textures="ktx2")
    monkeypatch.setitem(engine_projects.ENGINES, "unity", needy)
    names = runtime.pack(ocean(), engine="unity", reference=False).files
    assert {"tile0_h0.ktx2", "tile0_wave.ktx2", "twiddle.bin", "fftocean.hlsl"} <= set(names)
    names = runtime.pack(ocean(), engine="unity", textures="exr", reference=False).files
    assert "tile0_h0.exr" in names
    assert "tile0_h0.ktx2" not in names


def test_the_table_and_the_kernels_agree():
    assert set(engine_projects.LANGUAGES) == set(shaders.LANGUAGES)
    assert engine_projects.KERNEL_SIDE == shaders.MOST_SIDE


def test_a_package_of_an_engine_goes_through_a_container():
    package = runtime.pack(build.cascade(), engine="webgpu")
    again = runtime.from_bytes(runtime.to_bytes(package))
    assert again.files == package.files
    assert json.dumps(again.document) == json.dumps(package.document)
