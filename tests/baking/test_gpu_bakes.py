"""Bakes whose frames a graphics processor computes: the same bytes, and the adapter by its name."""

import pytest
from builders import job, require, tree

import fftocean as fo
from fftocean import computation
from fftocean.cli import main
from fftocean.job import parameters

SMALL = {
    "ocean.backend": "gpu",
    "ocean.n": 16,
    "bake.frames": 4,
    "bake.maps": ["height", "normal", "jacobian"],
    "bake.pictures": [],
}


@pytest.fixture
def adapter():
    """Return the adapter; skip or fail the test if there is none."""
    try:
        return fo.gpu.adapter()
    except fo.ParameterError as error:
        require(False, str(error))


def test_jobs_name_the_backends_of_an_ocean():
    assert parameters.BACKENDS == computation.BACKENDS


@pytest.mark.client
def test_a_bake_has_the_same_bytes_again(adapter, tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    fo.bake(job(SMALL), first)
    fo.bake(job(SMALL), second)
    assert tree(first) == tree(second)
    assert not fo.check(first)
    assert fo.load(first).manifest["made_with"]["fft"] == str(adapter)
    fo.bake(job(SMALL | {"ocean.backend": "auto"}), tmp_path / "cpu")
    seen, frame = (fo.load(tmp_path / name)["height"] for name in ("first", "cpu"))
    # halves hold 11 binary digits
    assert abs(seen - frame).max() <= 2.0**-10 * abs(frame).max()


@pytest.mark.client
@pytest.mark.usefixtures("adapter")
def test_a_bake_is_not_resumed_on_another_adapter(tmp_path, monkeypatch):
    """Nor is it written; without any adapter it is checked and loaded all the same."""
    fo.bake(job(SMALL), tmp_path)
    before = tree(tmp_path)
    other = fo.gpu.Adapter("another card", "Vulkan", "1.0", False, "0.32.0")
    monkeypatch.setattr("fftocean.baking.folder.identity.adapter", lambda: other)
    with pytest.raises(fo.OutputError, match=r"made_with\.fft: .* there, another card by Vulkan"):
        fo.bake(job(SMALL), tmp_path)
    assert tree(tmp_path) == before

    def absent():
        raise fo.ParameterError("there is no adapter")

    monkeypatch.setattr("fftocean.gpu.synthesis.device", absent)
    assert not fo.check(tmp_path)
    assert fo.load(tmp_path)["height"].shape == (4, 16, 16, 1)
    with pytest.raises(fo.JobError, match="there is no adapter"):
        fo.bake(job(SMALL), tmp_path / "new")


@pytest.mark.client
def test_info_and_verify_say_so(adapter, capsys):
    flags = ["--backend", "gpu", "--n", "16"]
    assert main(["info", *flags]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "graphics adapter" in printed
    assert "FFT library" not in printed
    for word in str(adapter).split():
        assert word in printed
    assert main(["verify", *flags]) == 0
    assert "16 x 16, float32" in capsys.readouterr().out


def test_a_job_falls_back_where_it_may(monkeypatch):
    def absent():
        raise fo.ParameterError("there is no adapter")

    monkeypatch.setattr("fftocean.gpu.synthesis.device", absent)
    with pytest.raises(fo.JobError, match="ocean: there is no adapter"):
        job(SMALL).ocean()
    assert job(SMALL | {"ocean.backend": "gpu-or-cpu"}).ocean().backend != "gpu"
    assert job(SMALL).ocean(dtype="float64").dtype == "float64"  # the CPU's


@pytest.mark.parametrize("flag", ["vulkan", ""])
def test_an_unknown_backend_of_a_job(flag):
    with pytest.raises(fo.JobError, match=r"ocean\.backend must be one of auto, mkl"):
        job(SMALL | {"ocean.backend": flag})
