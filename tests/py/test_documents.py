"""The code of the guide and of the notebooks runs."""

import json
import pathlib
import re

import pytest

import rara

ROOT = pathlib.Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "tools/examples/python").glob("*.ipynb"))


@pytest.fixture
def run(tmp_path, monkeypatch, renderer):
    """Runs pieces of code one after the other, and returns what they define. They share the renderer of all tests."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(rara, "Renderer", lambda *_: renderer)

    def run(pieces, name):
        names = {}
        for number, piece in enumerate(pieces):
            exec(compile(piece, f"{name}[{number}]", "exec"), names)
        return names

    return run


def test_the_guide(run):
    text = (ROOT / "src/guide/python.md").read_text()
    found = run(re.findall(r"```python\n(.*?)```", text, re.S), "python.md")
    assert found["pixels"].shape == found["bytes_"].shape == (240, 320, 4)
    assert found["depth"].shape == (120, 160)
    assert pathlib.Path("section_2.png").exists()


def test_there_are_notebooks():
    assert len(NOTEBOOKS) == 3


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks(run, path):
    cells = json.loads(path.read_text())["cells"]
    assert all(not cell.get("outputs") for cell in cells), "clear the outputs"
    run(["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"], path.name)
