"""Notebooks: executed afresh, and stored with the outputs of the same code."""

import pytest
import store_notebooks
from builders import ROOT

PATHS = sorted((ROOT / "notebooks").glob("*.ipynb"))


def read(path):
    import nbformat

    return nbformat.read(path, as_version=4)


@pytest.mark.parametrize("path", PATHS, ids=lambda path: path.stem)
@pytest.mark.filterwarnings("ignore")  # of the kernel's own libraries; cells assert what they claim
@pytest.mark.process
def test_a_notebook_runs(path):
    """Without its stored outputs; an error in a cell is raised."""
    notebook = read(path)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
    done = store_notebooks.execute(notebook)
    assert all(cell.execution_count for cell in done.cells if cell.cell_type == "code")


@pytest.mark.parametrize("path", PATHS, ids=lambda path: path.stem)
def test_the_outputs_are_those_of_the_code(path):
    notebook = read(path)
    stored = notebook.metadata["fftocean"]["code_sha256"]
    assert stored == store_notebooks.code_hash(notebook), (
        f"run python tools/store_notebooks.py {path.stem}"
    )
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1))
    kinds = [kind for cell in code for o in cell.outputs for kind in o.get("data", {})]
    assert "image/png" in kinds
    assert not {*kinds} & {*store_notebooks.LIVE}
    outputs = str([cell.outputs for cell in code])
    assert "Traceback" not in outputs
    for place in (str(ROOT), "ipykernel", "/tmp/"):  # of the machine, not of the sea
        assert place not in outputs


@pytest.mark.parametrize("path", PATHS, ids=lambda path: path.stem)
def test_a_notebook_asks_shows_and_lets_try(path):
    text = "\n".join(cell.source for cell in read(path).cells if cell.cell_type == "markdown")
    assert text.startswith("# ")
    for part in ("**Question.**", "**What to see.**", "**Try this.**"):
        assert part in text, part


def test_all_are_small_together():
    assert len(PATHS) == 8
    assert sum(path.stat().st_size for path in PATHS) < 3e6


def test_a_changed_cell_is_noticed():
    notebook = read(PATHS[0])
    before = store_notebooks.code_hash(notebook)
    next(cell for cell in notebook.cells if cell.cell_type == "markdown").source += " more"
    assert store_notebooks.code_hash(notebook) == before
    next(cell for cell in notebook.cells if cell.cell_type == "code").source += " "
    assert store_notebooks.code_hash(notebook) != before
