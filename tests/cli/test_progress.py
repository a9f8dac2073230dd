"""Progress: a bar on a terminal, lines of JSON elsewhere, each as it happens."""

import io
import json

import pytest

from fftocean.cli.progress import json_events, print_event, progress_bar
from fftocean.errors import JobError


class Stream(io.StringIO):
    """An error output that may be a terminal, and counts how often it is flushed."""

    def __init__(self, terminal):
        super().__init__()
        self._terminal, self.flushed = terminal, []

    def isatty(self):
        return self._terminal

    def flush(self):
        self.flushed.append(self.getvalue())


@pytest.mark.parametrize(
    ("terminal", "forced", "shown"),
    [(True, False, True), (False, False, False), (False, True, False)],
)
def test_a_bar_is_shown_on_a_terminal_alone(terminal, forced, shown, monkeypatch):
    """Colours may be forced on a file, as CI does; a bar may not."""
    monkeypatch.setenv("TERM", "xterm")
    if forced:
        monkeypatch.setenv("FORCE_COLOR", "1")
        monkeypatch.setenv("TTY_COMPATIBLE", "1")
    stream = Stream(terminal)
    monkeypatch.setattr("sys.stderr", stream)
    with progress_bar("baking", "frames", shown=True) as show:
        show(2, 3, "baking")
    assert ("2/3" in stream.getvalue()) == shown
    with progress_bar("baking", "frames", shown=False) as show:
        before = stream.getvalue()
        show(3, 3, "baking")
    assert "3/3" not in stream.getvalue().removeprefix(before)


def test_an_event_is_seen_when_it_happens(monkeypatch):
    """A program that reads the lines does not wait until a buffer is full."""
    stream = Stream(terminal=False)
    monkeypatch.setattr("sys.stdout", stream)
    print_event({"event": "frame", "name": "ü", "done": 1})
    assert stream.flushed[-1] == '{"event": "frame", "name": "\\u00fc", "done": 1}\n'
    with pytest.raises(ValueError, match="JSON"):
        print_event({"t": float("nan")})


@pytest.mark.parametrize(
    ("error", "message", "code"),
    [
        (JobError("no such key"), "no such key", 2),
        (KeyboardInterrupt(), "interrupted", 130),
        (SystemExit(143), "terminated", 143),
    ],
)
def test_the_last_event_is_the_error(error, message, code, capsys):
    def stopped():
        with json_events(True) as show:
            show({"event": "start"})
            raise error

    with pytest.raises(type(error)):
        stopped()
    first, last = map(json.loads, capsys.readouterr().out.splitlines())
    assert first == {"event": "start"}
    assert last == {"event": "error", "message": message, "exit_code": code}


def test_without_json_nothing_is_printed(capsys):
    with json_events(False) as show:
        assert show is None
    assert capsys.readouterr() == ("", "")
