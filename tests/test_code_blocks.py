"""
Code of README, CONTRIBUTING and docs: each page is one session in a folder of its own.

Blocks are run in the order of the page: Python in one namespace, commands of `fftocean` with few
samples after they were parsed as written. A comment `<!-- not run: REASON -->` on the line before
a block leaves it out; `<!-- new script -->` gives the Python from there on a namespace of its own.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import pytest
from builders import ROOT

from fftocean.cli import main
from fftocean.cli.job_flags import job_of
from fftocean.cli.parser import build_parser

PAGES = ["README.md", "CONTRIBUTING.md", *(
    p.relative_to(ROOT).as_posix() for p in sorted((ROOT / "docs").rglob("*.md"))
)]  # fmt: skip

HINT = (
    "mend the block, or put `<!-- not run: REASON -->` on the line before it (reasons: REASONS in "
    "tests/test_code_blocks.py), or `<!-- new script -->` if it does not continue the page"
)
REASONS = {
    "needs Blender": "tests/clients runs it where Blender is installed",
    "needs Godot": "tests/clients runs it where Godot is installed",
    "needs Unity": "Unity cannot be had without an account",
    "needs Unreal": "Unreal cannot be had without an account",
    "needs MuJoCo": "the extra `robots` is not part of the extra `test`",
    "needs a graphics adapter": "tests/test_gpu.py runs the same where there is one",
    "needs a cluster": "a scheduler and its workers on other machines",
    "installs packages": ".ci/run and each environment do that",
    "part of a program": "the lines around it are the reader's own",
    "takes minutes": "the same code is run by a test at a smaller size",
}
RUN_BY_CI = ("test",)  # the README's second command, which .ci/run takes from there

NOT_OURS = {
    "pip": "installs packages",
    "cd": "there is one folder",
    "git": "needs the network",
    "blender": "needs Blender",
    "godot": "needs Godot",
}
"""Programs whose commands are left out, and the reason."""

PARSED_ONLY = {
    "view": "serves until it is stopped; tests/view does that",
    "bench": "takes minutes; tests/bench does that",
}
"""Commands that are parsed and not run."""

FEW = 16
"""Samples a side of what commands are run with."""

OWN_TESTS = {"docs/extending.md": "tests/test_extending.py runs each recipe alone"}

_FENCE = re.compile(
    r"(?:^<!-- (?P<mark>[^\n]*?) -->\n+)?"
    r"^(?P<indent> *)(?P<fence>```+|:::+)(?:\{code-block\} *)?(?P<language>[\w-]*)[^\n]*\n"
    r"(?P<body>.*?)"
    r"^ *(?P=fence) *$",
    re.MULTILINE | re.DOTALL,
)


@dataclass(frozen=True)
class Block:
    """One fenced block of a page."""

    page: str
    line: int  # of its first line of code
    language: str
    mark: str
    code: str

    @property
    def left_out(self):
        """True if a comment leaves it out, or .ci/run has it."""
        return self.mark.startswith("not run") or self.mark in RUN_BY_CI


def blocks_of(page, text):
    """Return the blocks of a page, in order."""
    found = []
    for match in _FENCE.finditer(text):
        indent = len(match["indent"])
        code = "".join(row[indent:] for row in match["body"].splitlines(keepends=True))
        line = text[: match.start("body")].count("\n") + 1
        found.append(Block(page, line, match["language"], match["mark"] or "", code))
    return found


def read(page):
    return blocks_of(page, (ROOT / page).read_text(encoding="utf-8"))


def commands_of(block):
    """Return the commands of a block of a shell, each with its line; `\\` continues one."""
    found, line = [], block.line
    for whole in re.sub(r"\\\n", "\\\\\0", block.code).splitlines():
        text = whole.replace("\\\0", " ").strip()
        if block.language == "console":
            text = text.removeprefix("$ ") if text.startswith("$ ") else ""
        for part in text.split(" && "):
            if part and not part.startswith("#"):
                found.append((line, part))
        line += 1 + whole.count("\0")
    return found


def smaller(words):
    """Return the words of a command of `fftocean` with few samples, and without a browser."""
    own = vars(build_parser().parse_args(words))
    if own.get("tiles"):
        tiles = ",".join(f"{FEW}:{size:g}" for _, size in own["tiles"])
        return [*words, "--tiles", tiles]
    if isinstance(own.get("job"), Path) and own["job"].is_dir():
        return words
    few = ["--n", str(FEW)] if "n" in own else []
    if words[0] == "bake" and own["fps"] is not None:
        few += ["--loop", "1"]
    elif words[0] == "bake" and ":" not in (own["frames"] or ""):
        few += ["--frames", "4"]
    return [*words, *few]


def run_fftocean(words):
    """Parse a command as it is written, then run it with few samples."""
    options = build_parser().parse_args(words)
    if "set" in options and ":" not in (options.frames or ""):
        job_of(options)
    if words and words[0] in PARSED_ONLY and "--static" not in words:
        return
    code = main(smaller(words))
    assert code == 0, f"exit code {code}"


def run_command(text):
    """Run one command of a page, if its program is fftocean or Python."""
    words = shlex.split(text, comments=True)
    program = re.sub(r"^python[\d.]*$", "python", Path(words[0]).name)
    if program == "fftocean":
        run_fftocean(words[1:])
    elif program == "python" and words[1:3] not in (["-m", "venv"], ["-m", "pip"]):
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg"}
        done = subprocess.run(
            [sys.executable, *words[1:]], env=environment, capture_output=True, text=True,
            timeout=600, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
    else:
        assert program == "python" or program in NOT_OURS, f"{program} is no program of ours"


def run_page(blocks):
    """Run the blocks of a page in the current folder; an error names page and line."""
    namespace = {"__name__": "__main__"}
    for block in blocks:
        if block.mark == "new script":
            namespace = {"__name__": "__main__"}
        if block.left_out:
            continue
        line = [block.line]  # where the block is at
        try:
            if block.language == "python":
                source = "\n" * (block.line - 1) + block.code
                exec(compile(source, block.page, "exec"), namespace)
            elif block.language in ("bash", "console", "sh"):
                for line[0], text in commands_of(block):
                    run_command(text)
            elif block.language == "toml":
                tomllib.loads(block.code)
        except BaseException as error:  # a command that ends the process, too
            if isinstance(error, KeyboardInterrupt):
                raise
            at = error.__traceback__
            while at:
                if at.tb_frame.f_code.co_filename == block.page:
                    line[0] = at.tb_lineno
                at = at.tb_next
            what = f"{block.page}:{line[0]}: {type(error).__name__}: {error}"
            raise AssertionError(f"{what}\n{HINT}") from error


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    """Return a folder as a reader has it: the checkout's examples, buoy files, a job of a gale."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    shutil.copytree(ROOT / "tests" / "data" / "spectra", tmp_path / "tests" / "data" / "spectra")
    for file in (ROOT / "tests" / "data" / "spectra").iterdir():
        shutil.copy(file, tmp_path)
    shutil.copy(ROOT / "examples" / "north_sea_gale.toml", tmp_path / "gale.toml")
    return tmp_path


RUNNABLE = [
    page
    for page in PAGES
    if page not in OWN_TESTS
    and any(
        b.language in ("python", "bash", "console", "sh", "toml") and not b.left_out
        for b in read(page)
    )
]


@pytest.mark.parametrize("page", RUNNABLE)
@pytest.mark.usefixtures("checkout")
@pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
def test_the_code_of_a_page_runs(page):
    run_page(read(page))


def test_blocks_that_are_left_out_have_one_of_few_reasons():
    left_out = [b for page in PAGES for b in read(page) if b.mark.startswith("not run")]
    for block in left_out:
        reason = block.mark.removeprefix("not run").removeprefix(": ")
        assert reason in REASONS, f"{block.page}:{block.line}: {reason!r} is none of {[*REASONS]}"
    python = [b for page in PAGES for b in read(page) if b.language == "python"]
    assert sum(b.language == "python" for b in left_out) <= 0.1 * len(python)
    assert len(left_out) <= 30


def test_every_fence_is_read():
    """As many blocks as there are pairs of fences, so that none escapes."""
    for page in PAGES:
        text = (ROOT / page).read_text(encoding="utf-8")
        fences = re.findall(r"^ *(?:```)", text, re.MULTILINE)
        blocks = [m for m in _FENCE.finditer(text) if m["fence"].startswith("`")]
        assert len(fences) == 2 * len(blocks), page


def test_an_error_names_its_line_and_the_comment_that_leaves_a_block_out(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = "# A page\n\n```python\nx = 1\n```\n\n{}```python\ny = x\nnone_such\n```\n"
    with pytest.raises(AssertionError, match=r"(?s)page.md:9: NameError.*not run: REASON"):
        run_page(blocks_of("page.md", page.format("")))
    with pytest.raises(AssertionError, match=r"page.md:9: NameError: name 'x'"):
        run_page(blocks_of("page.md", page.format("<!-- new script -->\n")))
    run_page(blocks_of("page.md", page.format("<!-- not run: needs Unity -->\n")))
    for wrong in ("fftocean bkae", "fftocean verify gone.toml", "python gone.py", "fftcean bake"):
        command = f"```console\n$ fftocean --version\n$ {wrong}\n```\n"
        with pytest.raises(AssertionError, match=r"page.md:(2|3): "):
            run_page(blocks_of("page.md", command))
