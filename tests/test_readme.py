"""What the README and the notebooks show runs."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent


def after(marker, language):
    """The fenced block that follows a marker."""
    match = re.search(rf"<!-- {marker} -->\n```{language}\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    assert match, f"README.md has no {language} block after <!-- {marker} -->"
    return match.group(1)


def test_the_ten_lines_run(capsys):
    source = after("ten lines", "python")
    exec(compile(source, "README.md", "exec"), {})
    shape, *_, hs = capsys.readouterr().out.strip().splitlines()
    assert shape.startswith("(256, 256) ")
    delivered, ordered = map(float, hs.split())
    assert delivered == pytest.approx(ordered, rel=0.3)  # one draw of a tile of 500 m scatters by 7 %


def test_the_two_commands_are_one_line_each():
    assert "fftocean bake" in after("run", "bash")
    assert "pytest" in after("test", "bash")
    assert len(after("run", "bash").strip().splitlines()) == len(after("test", "bash").strip().splitlines()) == 1


def test_linked_files_exist():
    for target in re.findall(r"\]\(([^)#:]+)\)", (ROOT / "README.md").read_text(encoding="utf-8")):
        assert (ROOT / target).exists(), target


@pytest.mark.parametrize("path", sorted((ROOT / "notebooks").glob("*.ipynb")), ids=lambda p: p.name)
@pytest.mark.filterwarnings("ignore")  # of the kernel's own libraries; the notebook asserts what it claims
def test_notebooks_run(path):
    import nbclient
    import nbformat

    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(ROOT)}}).execute()
    assert not any(output.output_type == "error" for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs)


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
        if line.startswith("| ") and not line.startswith(("| where", "| printed", "| as often written", "|---"))
    ]
    assert [row for row in rows if "test_" not in row] == []
