"""Runs the examples of docs/python.md and docs/notebooks."""

import os
import re
import shutil
import subprocess
import sys

import nbformat
import pytest
from nbconvert.preprocessors import ExecutePreprocessor

NOTEBOOKS = ["first_look", "undistorted_events"]


@pytest.fixture
def folder(simulated, tmp_path):
    for name in ("recording.bag", "session.yaml"):
        shutil.copy(simulated / "short_bag" / name, tmp_path)
    return tmp_path


def test_the_pages_examples_run(source, folder):
    blocks = re.findall(r"^```python\n(.*?)^```$", (source / "docs" / "python.md").read_text(), re.MULTILINE | re.DOTALL)
    assert len(blocks) >= 8
    script = folder / "examples.py"
    script.write_text("\n".join(blocks))
    ran = subprocess.run([sys.executable, script], cwd=folder, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    assert "optimise: 100%" in ran.stdout and "left.rotation.x [rad]" in ran.stdout
    assert "nothing.yaml" in ran.stdout.splitlines()[-1]


def test_the_page_names_only_what_there_is(source):
    import evical

    named = set(re.findall(r"\bevical\.([A-Za-z]\w+)", (source / "docs" / "python.md").read_text())) - {"errors"}
    assert {name for name in named if not hasattr(evical, name)} == set()


def notebook(source, name):
    return nbformat.read(source / "docs" / "notebooks" / f"{name}.ipynb", as_version=4)


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_notebook_runs(source, folder, name, monkeypatch):
    monkeypatch.setenv("HOME", str(folder))
    monkeypatch.setenv("IPYTHONDIR", str(folder / "ipython"))
    page = notebook(source, name)
    stored = kinds(page)
    folder.joinpath("demo").mkdir()
    for file in ("recording.bag", "session.yaml"):
        folder.joinpath(file).rename(folder / "demo" / file)
    ExecutePreprocessor(timeout=300, kernel_name="python3").preprocess(page, {"metadata": {"path": str(folder)}})
    if os.environ.get("EVICAL_WRITE_NOTEBOOKS"):
        write(page, source / "docs" / "notebooks" / f"{name}.ipynb")
    else:
        assert kinds(page) == stored


def kinds(page):
    """Outputs of each cell; printed text may be in one part or in several."""
    return [{output.output_type for output in cell.outputs} for cell in page.cells if cell.cell_type == "code"]


def write(page, path):
    """To write the notebooks again, run this test with EVICAL_WRITE_NOTEBOOKS=1."""
    for cell in page.cells:
        cell.get("metadata", {}).pop("execution", None)
        printed = [output for output in cell.get("outputs", []) if output.output_type == "stream"]
        for output in printed[1:]:
            printed[0].text += output.text
            cell.outputs.remove(output)
    page.metadata = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
                     "language_info": {"name": "python"}}
    path.write_text(nbformat.writes(page) + "\n")


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_notebook_is_stored_as_it_was_run(source, name):
    """With outputs and pictures, in order, without errors or paths of the machine that ran it."""
    page = notebook(source, name)
    code = [cell for cell in page.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1))
    outputs = [output for cell in code for output in cell.outputs]
    assert any("image/png" in output.get("data", {}) for output in outputs)
    assert all(output.output_type != "error" and output.get("name") != "stderr" for output in outputs)
    texts = [cell.source for cell in page.cells] + [
        str(output.get("text", "")) + str(output.get("data", {}).get("text/plain", "")) for output in outputs
    ]
    for text in texts:
        assert not re.search(r"(^|[\s'\"(])(/(home|work|root|tmp|usr|build|var)\b|[A-Z]:\\)", text), text


def test_notebooks_are_small(source):
    for name in NOTEBOOKS:
        assert (source / "docs" / "notebooks" / f"{name}.ipynb").stat().st_size < 400_000
