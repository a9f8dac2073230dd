"""
Bakes among unusual files: those of other programs, lost sidecars, special names, false manifests.
"""

import shutil

import builders
import pytest

import fftocean as fo
from fftocean.baking import bake as baker
from fftocean.baking.folder import layout

DATA = builders.SPECTRA
JOB = builders.job({"ocean.n": 16, "bake.frames": 4, "bake.maps": ["height"], "bake.pictures": []})


def bake(folder, changes=None, **options):
    return fo.bake(JOB.replaced(changes or {}), folder, executor="serial", **options)


def test_previews_may_be_none(tmp_path):
    bake(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "height",
        "job.json",
        "manifest.json",
    ]
    assert fo.check(tmp_path) == ()


@pytest.mark.parametrize("name", ["height/0000.exr", "height.bin", "preview.png"])
def test_files_of_others_are_not_written_over(tmp_path, name):
    (tmp_path / "height").mkdir()
    (tmp_path / name).write_text("mine")
    for overwrite in (False, True):  # no job.json or manifest.json lists the file
        with pytest.raises(fo.OutputError, match=name):
            bake(tmp_path, overwrite=overwrite)
        assert (tmp_path / name).read_text() == "mine"
    (tmp_path / name).unlink()
    bake(tmp_path)
    assert fo.check(tmp_path) == ()


def test_a_measured_file_may_have_any_name(tmp_path):
    """Also that of a number which JSON does not have."""
    shutil.copy(DATA / "swanfile.spec", tmp_path / "Infinity.spec")
    job = fo.Job.from_toml(
        "[[sea.systems]]\nmeasured = { file = 'Infinity.spec' }\n",
        source=str(tmp_path / "job.toml"),
    )
    assert job.describe()["sea.systems"] == [{"measured": {"file": "Infinity.spec"}}]
    assert job.describe()["sea.depth"] == "inf"


def test_an_atlas_is_judged_by_the_frames_that_it_will_hold(tmp_path):
    """127 pictures of 256 rows stand in no grid within 16384; 128 of them, of a loop of 254, do."""
    atlas = {"bake.format": "exr-atlas", "ocean.n": 256, "bake.frames": 254}
    with pytest.raises(fo.JobError, match="127"):
        bake(tmp_path / "refused", atlas, frames="0:127")
    assert not (tmp_path / "refused").exists()
    baker.scene_for(JOB.replaced(atlas), 1, 128)


@pytest.mark.parametrize("harm", ["gone", "emptied"])
def test_a_sidecar_for_an_engine_is_written_again(tmp_path, harm):
    settings = {"bake.format": "exr-atlas", "bake.engine": "godot"}
    bake(tmp_path, settings)
    sidecar = tmp_path / "height.exr.import"
    whole = sidecar.read_bytes()
    sidecar.unlink() if harm == "gone" else sidecar.write_bytes(b"")
    assert fo.check(tmp_path)
    fo.repair(tmp_path, executor="serial")
    assert sidecar.read_bytes() == whole
    sidecar.write_bytes(whole + b"\n[more]\n")  # as Godot does
    assert fo.check(tmp_path) == ()
    bake(tmp_path, settings)
    assert sidecar.read_bytes().endswith(b"[more]\n")


def test_a_manifest_that_is_a_job_s_file_is_none(tmp_path):
    manifest = bake(tmp_path)
    shutil.copy(tmp_path / "job.json", tmp_path / "manifest.json")
    assert [finding.kind for finding in fo.check(tmp_path)] == ["manifest"]
    assert fo.repair(tmp_path, executor="serial") == manifest
    shutil.copy(tmp_path / "manifest.json", tmp_path / "job.json")
    assert [finding.kind for finding in fo.check(tmp_path)] == ["job"]


def test_what_is_left_of_the_work_is_no_fault_of_a_finished_bake(tmp_path, monkeypatch):
    def interrupted(_):
        raise KeyboardInterrupt

    monkeypatch.setattr(baker, "remove_workspace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        bake(tmp_path)
    assert (tmp_path / layout.WORK_FOLDER).is_dir()
    assert fo.check(tmp_path) == ()


@pytest.mark.parametrize("form", ["png16", "r16"])
def test_scaled_formats_can_be_baked_again_and_repaired(tmp_path, form):
    """A finished bake's range is that of its manifest: it is not surveyed twice, nor lost."""
    settings = {"bake.format": form, "bake.pictures": ["sheet"]}
    manifest = bake(tmp_path, settings)
    assert bake(tmp_path, settings) == manifest
    (tmp_path / "preview.png").write_bytes(b"bent")
    assert fo.repair(tmp_path, executor="serial") == manifest
    (tmp_path / "manifest.json").unlink()
    assert bake(tmp_path, settings) == manifest
