"""Generated references: docs/job.md and docs/cli.md are those of the tables of keys and flags."""

import tomllib

import pytest
import references

import fftocean as fo
from fftocean.cli.parser import COMMANDS
from fftocean.job.parameters import PARAMETERS
from fftocean.physics.spectra import SPECTRA
from fftocean.physics.spreading import SPREADINGS


@pytest.mark.parametrize("name", references.PAGES)
def test_the_page_is_current(name):
    text = (references.DOCS / name).read_text(encoding="utf-8")
    assert text == references.PAGES[name](), "run python tools/references.py"


def test_every_key_kind_and_command_has_its_row():
    """Read from the page itself: a row that the generator forgets is missed."""
    job = (references.DOCS / "job.md").read_text(encoding="utf-8")
    for parameter in PARAMETERS:
        table, _, name = parameter.key.rpartition(".")
        section = job.partition(f"## `[{table}]`")[2].partition("\n## ")[0]
        assert f"| `{name}` |" in section, parameter.key
    for name in (*SPECTRA, *SPREADINGS):
        assert f"| `{name}` |" in job, name
    cli = (references.DOCS / "cli.md").read_text(encoding="utf-8")
    for command in COMMANDS:
        assert f"## `{command.name}`" in cli


def test_the_example_is_a_job():
    example = references.HOW_TO_NAME.partition("```toml\n")[2].partition("```")[0]
    job = fo.Job.from_tree(tomllib.loads(example))
    assert len(job.sea().systems) == 2
