"""The lock on a folder: never two bakes at once, and stale locks never block."""

import errno
import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

import fftocean as fo
from fftocean.baking.folder import lock
from fftocean.baking.folder.lock import LOCK_FILE, locked, require_free, require_held
from fftocean.errors import FolderInUseError, OutputError

HOLDER = """
import pathlib, sys, time
from fftocean.baking.folder.lock import locked
with locked(pathlib.Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.read()  # until the test lets go, or is gone itself
"""

WORKER = (
    "import pathlib, sys, time\nwhile not pathlib.Path(sys.argv[1], 'go').exists(): "
    "time.sleep(0.01)"
)


@pytest.fixture
def holder(tmp_path):
    """Another process that holds the folder."""
    environment = {**os.environ, "PYTHONPATH": str(Path(fo.__file__).parent.parent)}
    command, pipe = [sys.executable, "-c", HOLDER, str(tmp_path)], subprocess.PIPE
    process = subprocess.Popen(command, stdin=pipe, stdout=pipe, env=environment, text=True)
    with process:
        assert process.stdout.readline() == "held\n"
        yield process
        process.kill()


def test_a_held_folder_is_refused_at_once_and_names_its_holder(tmp_path, holder):
    """The one wait is `PATIENCE`; the clock is not asked, as the machine may be busy."""
    assert lock.PATIENCE <= 1.0
    for attempt in (lambda: locked(tmp_path).__enter__(), lambda: require_free(tmp_path)):
        with pytest.raises(
            FolderInUseError, match=rf"in use by another bake, process {holder.pid} on "
        ) as caught:
            attempt()
        assert caught.value.exit_code == 6


def test_the_second_bake_gives_up_within_two_seconds(tmp_path, monkeypatch):
    """By a clock that only the waits move."""
    waits = []

    def sleep(seconds):
        waits.append(seconds)
        assert sum(waits) <= 2.0

    clock = SimpleNamespace(monotonic=lambda: sum(waits), sleep=sleep)
    monkeypatch.setattr(lock, "time", clock)
    monkeypatch.setattr(lock, "_try_lock", lambda _: False)
    for attempt in (lambda: locked(tmp_path).__enter__(), lambda: require_free(tmp_path)):
        waits.clear()
        with pytest.raises(FolderInUseError, match="in use by another bake"):
            attempt()
        assert sum(waits) >= 0.5  # workers of a bake that was just killed have a moment


def test_a_lock_ends_with_its_process(tmp_path, holder):
    """kill -9 leaves the file, which keeps nobody out."""
    holder.send_signal(signal.SIGKILL)
    holder.wait()
    assert (tmp_path / LOCK_FILE).exists()
    require_free(tmp_path)
    with locked(tmp_path):
        assert json.loads((tmp_path / LOCK_FILE).read_text())["pid"] == os.getpid()
    assert not (tmp_path / LOCK_FILE).exists()


def test_a_process_that_is_ending_is_waited_for(tmp_path, holder, monkeypatch):
    monkeypatch.setattr(lock, "PATIENCE", 600.0)
    threading.Timer(0.3, holder.kill).start()
    with locked(tmp_path):
        pass


def test_two_threads_are_two_bakes(tmp_path, monkeypatch):
    """The lock is the folder's, not the process'."""
    monkeypatch.setattr(lock, "PATIENCE", 0.1)
    with locked(tmp_path), pytest.raises(FolderInUseError), locked(tmp_path):
        pass
    with locked(tmp_path):
        pass


def test_of_many_at_once_one_holds_at_any_time(tmp_path, monkeypatch):
    """
    Taking, removing and making the file anew race with each other: nobody may hold a file that has
    no name any more.
    """
    monkeypatch.setattr(lock, "PATIENCE", 600.0)
    inside, most, errors = [], [], []

    def work():
        try:
            for _ in range(20):
                with locked(tmp_path):
                    inside.append(1)
                    most.append(len(inside))
                    time.sleep(0.0005)
                    inside.pop()
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=work) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not errors
    assert len(most) == 120
    assert max(most) == 1


def test_a_file_that_lost_its_name_is_no_lock(tmp_path, monkeypatch):
    """
    Its holder removes it between our opening it and our locking it: another could make a new one,
    and hold that.
    """
    real, calls = lock._try_lock, []

    def seized(descriptor):
        calls.append(descriptor)
        if len(calls) == 1:
            (tmp_path / LOCK_FILE).unlink()
        return real(descriptor)

    monkeypatch.setattr(lock, "_try_lock", seized)
    with locked(tmp_path) as hold:
        assert os.path.samestat((tmp_path / LOCK_FILE).stat(), os.fstat(hold.descriptor))
    assert len(calls) == 2


def test_a_process_with_the_descriptor_holds_it_too(tmp_path, monkeypatch):
    """A worker that outlives a bake that was killed keeps the folder until it is gone itself."""
    worker = (
        f"subprocess.Popen([sys.executable, '-c', {WORKER!r}, sys.argv[1]], "
        f"pass_fds=(hold.descriptor,))"
    )
    program = HOLDER.replace(
        ":\n    print", f" as hold:\n    import subprocess; {worker}\n    print"
    )
    environment = {**os.environ, "PYTHONPATH": str(Path(fo.__file__).parent.parent)}
    command, pipe = [sys.executable, "-c", program, str(tmp_path)], subprocess.PIPE
    process = subprocess.Popen(command, stdin=pipe, stdout=pipe, env=environment, text=True)
    with process:
        assert process.stdout.readline() == "held\n"
        process.kill()
        process.wait()
        monkeypatch.setattr(lock, "PATIENCE", 0.1)
        with pytest.raises(FolderInUseError):
            require_free(tmp_path)
        (tmp_path / "go").touch()
        monkeypatch.setattr(lock, "PATIENCE", 600.0)
        require_free(tmp_path)


def test_a_token_differs_from_lock_to_lock(tmp_path):
    """For workers elsewhere: they go on for as long as their bake has the folder, and no longer."""
    with locked(tmp_path) as first:
        require_held(tmp_path, first.token)
    with pytest.raises(FolderInUseError, match="not held by this bake any more"):
        require_held(tmp_path, first.token)
    with locked(tmp_path) as second:
        assert second.token != first.token
        with pytest.raises(FolderInUseError, match="not held by this bake any more"):
            require_held(tmp_path, first.token)


@pytest.mark.parametrize(
    "text", [b"", b"{", b"[]", b'{"pid": 1}', b"\xff" * 9000, b'{"pid": "x\\u001b[31m", "host": 5}']
)
def test_a_stale_file_may_hold_anything(tmp_path, text):
    (tmp_path / LOCK_FILE).write_bytes(text)
    require_free(tmp_path)
    with locked(tmp_path):
        pass


def test_what_is_no_file_is_no_lock(tmp_path):
    """A link is not followed, a folder is not taken."""
    outside = tmp_path / "outside"
    outside.write_text("precious")
    for i, plant in enumerate((lambda p: p.symlink_to(outside), lambda p: p.mkdir())):
        folder = tmp_path / str(i)
        folder.mkdir()
        plant(folder / LOCK_FILE)
        require_free(folder)
        with pytest.raises(OutputError, match=r"\.lock could not be written"), locked(folder):
            pass
    assert outside.read_text() == "precious"


@pytest.mark.parametrize("call", ["ftruncate", "write"])
def test_a_disk_that_cannot_be_written_is_an_output_error(tmp_path, monkeypatch, call):
    def fail(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(lock.os, call, fail)
    with (
        pytest.raises(OutputError, match=r"\.lock could not be written: No space left") as caught,
        locked(tmp_path),
    ):
        pass
    assert caught.value.exit_code == 4
    monkeypatch.undo()
    assert not (tmp_path / LOCK_FILE).exists()
    with locked(tmp_path):
        pass


def test_windows_has_a_lock_of_its_own(tmp_path, monkeypatch):
    """
    By the byte, far beyond what is written, so that others may read who holds it; there no open
    file can be removed.
    """
    taken = []

    class Msvcrt:
        LK_NBLCK = 2

        @staticmethod
        def locking(descriptor, mode, count):
            if taken:
                raise OSError(errno.EACCES, "Permission denied")
            taken.append((os.lseek(descriptor, 0, os.SEEK_CUR), mode, count))

    monkeypatch.setattr(lock, "fcntl", None)
    monkeypatch.setattr(lock, "msvcrt", Msvcrt)
    monkeypatch.setattr(lock, "PATIENCE", 0.1)
    with locked(tmp_path):
        assert taken == [(1 << 30, 2, 1)]
        with pytest.raises(FolderInUseError), locked(tmp_path):
            pass
    monkeypatch.setattr(lock, "msvcrt", None)
    with pytest.raises(OutputError, match="no file locks"), locked(tmp_path):
        pass
