"""Answers, tables and figures in a notebook."""

from base64 import b64decode, b64encode
from dataclasses import replace

import fake_solutions
import nbformat
import numpy as np
import pytest
from nbclient import NotebookClient

import sheetbench as sb
from comparisons.comparison.answer import Comparison

SCENE = sb.load("one-edge-clamped")
PNG = b"\x89PNG\r\n\x1a\n"
CELLS = (
    "import sheetbench as sb\nboth = sb.compare('one-edge-clamped', grid=5, elements=4)\nboth",
    "both.figures()[0].figure()",
    "both.lattice.figures()[0]",
    "both.tables()[1]",
    "sb.solve('one-edge-clamped', grid=3)",
)


def test_an_answer_shows_its_tables_its_sentence_and_its_picture_drawn_once():
    both = Comparison(
        SCENE, (fake_solutions.solution(SCENE), fake_solutions.solution(SCENE, "shell", -0.011))
    )
    shown = both._repr_mimebundle_()
    assert set(shown) == {"text/html", "image/png"} and shown["image/png"].startswith(PNG)
    assert b64encode(shown["image/png"]).decode() in shown["text/html"]
    assert both.sentence in shown["text/html"] and "Cost and error of each model" in shown["text/html"]
    assert shown["text/html"].count("<table>") == len(both.printed())
    assert "factorisations" not in shown["text/html"] and "factorisations" in both.tables()[1]._repr_html_()
    assert both._repr_png_() == shown["image/png"] and both._repr_html_() == shown["text/html"]


def test_what_a_scene_says_is_text_and_what_cannot_be_drawn_is_left_out():
    scene = SCENE.replace(title="<script>alert(1)</script>")
    lost = fake_solutions.solution(scene, sample=lambda points: np.full((len(points), 3), np.nan))
    lost.mesh.point_data["displacement"][:] = np.nan
    answer = Comparison(scene, (lost, fake_solutions.solution(scene, "shell")))
    shown = answer._repr_mimebundle_()
    assert set(shown) == {"text/html"} and answer._repr_png_() is None
    assert "<script>" not in shown["text/html"] and "&lt;script&gt;" in shown["text/html"]


def test_a_long_table_is_cut_and_says_so():
    (table, *_) = Comparison(SCENE, (fake_solutions.solution(SCENE),) * 2).tables()
    long = replace(table, rows=table.rows * 20)
    assert "more rows" not in long._repr_html_() and long._repr_html_().count("<tr>") == len(long.rows) + 1


@pytest.mark.nightly
def test_a_notebook_is_run_and_looked_at():
    """What is done while it runs is in one place, which is empty at the end."""
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in CELLS])
    NotebookClient(notebook, timeout=500, kernel_name="python3").execute()
    kinds = []
    for cell in notebook.cells:
        *before, last = cell.outputs
        assert all(one.output_type == "display_data" and not any(one.data.values()) for one in before)
        kinds.append(set(last.data) - {"text/plain"})
        if "image/png" in last.data:
            assert b64decode(last.data["image/png"]).startswith(PNG)
    both = {"text/html", "image/png"}
    assert kinds == [both, {"image/png"}, {"image/png"}, {"text/html"}, both]


def test_a_picture_says_what_it_is_in_a_line():
    both = Comparison(SCENE, (fake_solutions.solution(SCENE),) * 2)
    assert len(repr(both.figures()[0])) < 400
