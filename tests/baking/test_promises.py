"""Promises of bakes: slices of frames, and contents that are verified before they are used."""

import pytest

from fftocean.baking.finished import containers
from fftocean.baking.folder.plan import frames_of
from fftocean.baking.folder.sealed import read_sealed, sealed
from fftocean.errors import IntegrityError, JobError
from fftocean.files import as_json


@pytest.mark.parametrize("text", ["7:2:-1", "::-1", "5:5", "9:3", "0:8:0", "2", "1:2:3:4", "a:b"])
def test_slices_that_go_backward_or_nowhere_are_refused(text):
    with pytest.raises(JobError, match="frames must"):
        frames_of(text, 8)


@pytest.mark.parametrize("text", ["0:8", "2:7:2", ":3", "5:", "-3:", "1:100:3", "7:8"])
def test_slices_are_those_of_a_list(text):
    chosen = frames_of(text, 8)
    assert tuple(chosen) == tuple(eval(f"list(range(8))[{text}]"))
    assert len(set(chosen)) == len(chosen)


def test_a_changed_value_of_a_sealed_file_is_found(tmp_path):
    """The file stays JSON as a bake writes it: only the checksum tells."""
    path = tmp_path / "manifest.json"
    path.write_bytes(as_json(sealed({"frames": 12})))
    assert read_sealed(path) == {"frames": 12}
    path.write_bytes(path.read_bytes().replace(b"12", b"13"))
    with pytest.raises(IntegrityError, match="was changed after it was written"):
        read_sealed(path)


def test_parts_are_verified_before_they_are_put_into_a_container(tmp_path, monkeypatch):
    """One bit of the second part: the first is given, the second named."""
    rows = [
        {"frame": 3, "files": {"height": {"sha256": containers.digest(b"one")}}},
        {"frame": 4, "files": {"height": {"sha256": containers.digest(b"two")}}},
    ]
    monkeypatch.setattr(
        containers.layout, "frame_file", lambda _form, name, frame, _place: f"{name}.{frame}"
    )

    class Scene:
        form = None

    (tmp_path / "height.3").write_bytes(b"one")
    (tmp_path / "height.4").write_bytes(b"two")
    assert list(containers._parts(tmp_path, Scene, "height", rows)) == [b"one", b"two"]
    (tmp_path / "height.4").write_bytes(b"twn")
    parts = containers._parts(tmp_path, Scene, "height", rows)
    assert next(parts) == b"one"
    with pytest.raises(IntegrityError, match=r"height\.4 was changed after it was written"):
        next(parts)
    (tmp_path / "height.4").unlink()
    with pytest.raises(IntegrityError, match=r"height\.4"):
        list(containers._parts(tmp_path, Scene, "height", rows))
