"""The README: its ten lines, its commands, its links and the waves that it names."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import fftocean as fo
from fftocean.baking.previews import previews as pictures
from fftocean.physics import presets

ROOT = Path(__file__).parent.parent


def after(marker, language):
    """The fenced block that follows a marker."""
    match = re.search(
        rf"<!-- {marker} -->\n```{language}\n(.*?)```",
        (ROOT / "README.md").read_text(encoding="utf-8"),
        re.DOTALL,
    )
    assert match, f"README.md has no {language} block after <!-- {marker} -->"
    return match.group(1)


def test_the_ten_lines_run(capsys):
    source = after("ten lines", "python")
    exec(compile(source, "README.md", "exec"), {})
    shape, *_, hs = capsys.readouterr().out.strip().splitlines()
    assert shape.startswith("(256, 256) ")
    realised, specified = map(float, hs.split())
    assert realised == pytest.approx(
        specified, rel=0.3
    )  # one draw of a tile of 500 m scatters by 7 %


def test_the_two_commands_are_one_line_each():
    assert "fftocean bake" in after("run", "bash")
    assert "pytest" in after("test", "bash")
    assert (
        len(after("run", "bash").strip().splitlines())
        == len(after("test", "bash").strip().splitlines())
        == 1
    )


DEFAULT = ("README.md", "fftocean/job/default.toml")


@pytest.mark.parametrize(
    "name", [*DEFAULT, *(f"examples/{p.name}" for p in sorted((ROOT / "examples").glob("*.toml")))]
)
@pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
def test_waves_in_prose_are_those_of_the_job(name):
    """
    Each "waves of H m (Hs) and T s (Tp)", to the digits given; and a breeze, gale or storm by the
    name of its wind.
    """
    text = " ".join((ROOT / name).read_text(encoding="utf-8").replace("#", " ").split())
    job = fo.Job.default() if name in DEFAULT else fo.Job.read(ROOT / name)
    waves = re.findall(r"waves of (\d+\.?\d*) m \(Hs\) and (\d+\.?\d*) s \(Tp\)", text)
    named = []
    assert waves or name not in DEFAULT
    for given in waves:
        for said, true in zip(given, (job.sea().hs, job.sea().tp), strict=True):
            assert said == f"{true:.{len(said.partition('.')[2])}f}"
    scale = {row.name.lower(): row.number for row in presets.beaufort_table()}
    for wind in re.findall(
        r"\ba ((?:\w+ )?(?:breeze|gale|storm)) (?:on a|that has|\(beaufort)", text.lower()
    ):
        assert scale[wind] == pictures.beaufort_of(job.settings["sea.wind.speed"])
        named.append(wind)
    assert named or name not in DEFAULT


PAGES = ["README.md", "CONTRIBUTING.md", *sorted(f"docs/{p.name}" for p in ROOT.glob("docs/*.md"))]


@pytest.mark.parametrize("page", PAGES)
def test_linked_files_exist(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#:\s]+)\)", text):
        assert ((ROOT / page).parent / target).exists(), target


@pytest.mark.parametrize("page", ["CONTRIBUTING.md", "docs/architecture.md"])
def test_named_places_exist(page):
    """Files and folders between backticks, from the root or from the package."""
    text = (ROOT / page).read_text(encoding="utf-8")
    named = re.findall(r"`([\w/.]+(?:/|\.(?:py|md|toml)))`", text)
    assert len(named) > 5
    for place in named:
        assert (ROOT / place).exists() or (ROOT / "fftocean" / place).exists(), place


@pytest.mark.parametrize("folder", ["fftocean", "tests", "benchmarks", "docs", "examples"])
def test_nothing_refers_to_pages_that_are_not_here(folder):
    """A page that is named in capitals with its suffix stands in the repository."""
    for path in [
        p
        for p in (ROOT / folder).rglob("*")
        if p.suffix in (".py", ".md", ".toml") and "node_modules" not in p.parts
    ]:
        text = path.read_text(encoding="utf-8")
        for page in re.findall(r"\b([A-Z]{4,}\.md)\b", text):
            assert list(ROOT.rglob(page)), f"{path.relative_to(ROOT)}: {page}"
        assert not re.search(r"\bDE" + r"SIGN\b", text), path.relative_to(ROOT)


def test_every_test_that_the_errata_name_is_there():
    """Each row of docs/errata.md is pinned by a test of that name, in the file that it gives."""
    text = (ROOT / "docs" / "errata.md").read_text(encoding="utf-8")
    named = re.findall(r"`(?:(tests/[\w/]+\.py)::)?(test_\w+)`", text)
    assert len(named) > 30
    for file, name in named:
        source = (ROOT / (file or "tests/gerstner/test_few_waves.py")).read_text(encoding="utf-8")
        assert f"def {name}(" in source, f"{file}::{name}"
    rows = [
        line
        for line in text.splitlines()
        if line.startswith("| ")
        and not line.startswith(("| where", "| printed", "| as often written", "|---"))
    ]
    assert [row for row in rows if "test_" not in row] == []


@pytest.mark.parametrize("there", [True, False])
@pytest.mark.process
def test_the_box_rides_with_and_without_matplotlib(tmp_path, there):
    """The example ends well without it, and says what it would need."""
    script = "import runpy, sys; sys.argv[1:] = ['--seconds', '0.2', '--picture', 'box.png']; "
    script += "" if there else "sys.modules.update(matplotlib=None); "
    script += f"runpy.run_path({str(ROOT / 'examples/buoyancy.py')!r}, run_name='__main__')"
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg"}
    done = subprocess.run(
        [sys.executable, "-c", script],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == 0, done.stderr
    assert "10 steps at 50 Hz" in done.stdout
    assert (tmp_path / "box.png").exists() == there
    assert ("pip install '.[plot]'" in done.stdout) == (not there)
