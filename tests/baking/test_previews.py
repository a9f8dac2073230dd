"""Previews of a bake: those of the job, listed with checksums; a missing package is named first."""

import hashlib
import importlib.util

import builders
import pytest

import fftocean as fo
from fftocean.baking.folder import layout

JOB = builders.job({"ocean.n": 16, "bake.frames": 2, "bake.maps": ["height"]})
ALL = ["sheet", "animation", "tiling", "spectrum"]


def test_every_preview_of_the_job_exists_and_listed(tmp_path):
    manifest = fo.bake(JOB.replaced({"bake.pictures": ALL}), tmp_path / "sea", executor="serial")
    for key, name in zip(
        ("preview", "animation", "tiling", "spectrum"), layout.PREVIEW_FILES, strict=True
    ):
        data = (tmp_path / "sea" / name).read_bytes()
        assert manifest[key] == {
            "path": name,
            "bytes": len(data),
            "sha256": hashlib.sha256(data).hexdigest(),
        }
    assert fo.check(tmp_path / "sea") == ()


def test_the_spectrum_needs_matplotlib_and_says_so_first(tmp_path, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    with pytest.raises(fo.JobError, match="needs matplotlib"):
        fo.bake(JOB.replaced({"bake.pictures": ["spectrum"]}), tmp_path / "sea", executor="serial")
    assert not (tmp_path / "sea").exists()
