"""Tables as lines of text: whole at any width; broken, spaced or stacked where that is narrow."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rich.cells import cell_len

from sheetbench.answers import escape
from sheetbench.answers.layout import blocks
from sheetbench.answers.table import Column, Table, number

WIDE = Table(
    "Wide",
    (
        Column("probe"),
        Column("model"),
        *(Column(f"error of the {name}", "", "%", 100.0, ".2e") for name in ("first", "second", "third")),
        Column("factorisations", form="d"),
        Column("status", prose=True),
    ),
    (
        ("P1", "lumped-uniform", 7.64e-7, -0.01, 12.213, 12345, "strain-outside-model at 40 % of the load"),
        ("P1", "shell", 7.64e-7, -0.01, None, 7, "converged"),
    ),
)


def text_of(table, width):
    return [line for block in blocks(table, width) for line in [*block.head, block.rule, *block.rows]]


@pytest.mark.parametrize("width", [30, 50, 80, 160, None])
def test_every_figure_and_status_is_whole_at_any_width(width):
    lines = text_of(WIDE, width)
    words = " ".join(lines).split()
    for row in WIDE.shown_rows():
        for shown in row:
            assert set(shown.split()) <= set(words)
    assert width is None or max(map(cell_len, lines)) <= width


def test_a_notebook_prints_the_same_text(monkeypatch):
    on_a_terminal = text_of(WIDE, 100)
    monkeypatch.setattr("rich.console._is_jupyter", lambda: True)
    assert text_of(WIDE, 100) == on_a_terminal


def test_a_narrow_table_is_stacked_in_blocks_that_name_their_rows():
    narrow = blocks(WIDE, 50)
    assert len(narrow) > 1 and len(blocks(WIDE, 160)) == len(blocks(WIDE, None)) == 1
    assert all("lumped-uniform" in block.rows[0] and "probe" in " ".join(block.head) for block in narrow)
    headings = " ".join(" ".join(block.head) for block in narrow)
    assert headings.count("factorisations") == 1 and headings.count("status") == 1


def test_blocks_repeat_the_figures_that_tell_rows_apart():
    figures = [Column(name, form="d") for name in ("masses", "ratio", "limit_of_the_step", "iterations_used")]
    table = Table("Cells", tuple(figures), ((5, 1, 10, 20), (5, 100, 30, 40)))
    first, second = blocks(table, 36)
    assert [row.split() for row in first.rows] == [["5", "1", "10"], ["5", "100", "30"]]
    assert [row.split() for row in second.rows] == [["5", "1", "20"], ["5", "100", "40"]]


@settings(max_examples=30)
@given(
    st.lists(st.tuples(st.text(max_size=30), st.floats(), st.text(max_size=60)), max_size=4),
    st.integers(4, 100),
)
def test_no_text_is_lost_or_too_wide(rows, width):
    table = Table("", (Column("name"), Column("x", form=".3e"), Column("said", prose=True)), tuple(rows))
    lines = text_of(table, width)
    assert all(cell_len(line) <= max(width, 20) for line in lines)
    printed = "".join(lines).replace(" ", "")
    for name, _, said in rows:
        for word in (*escape.terminal(name).split(), *escape.terminal(said).split()):
            assert set(word) <= set(printed)


def test_rows_of_a_group_stand_under_its_name():
    table = Table("", (Column("probe"), Column("x", form="d")), (("P1", 1), ("P1", 2), ("P2", 3)), "", True)
    (block,) = blocks(table, None)
    assert [row.split() for row in block.rows] == [["P1", "1"], ["2"], ["P2", "3"]]


def test_in_blocks_every_row_names_its_group():
    columns = (Column("code"), Column("key"), Column("value", form="d"), Column("meaning", prose=True))
    rows = tuple(("a code with a name", key, 1, "a meaning in a few words") for key in ("first", "second"))
    parts = blocks(Table("", columns, rows, "", True), 36)
    assert len(parts) == 2
    assert all(sum(row.count("a code") for row in block.rows) == len(rows) for block in parts)


@pytest.mark.parametrize(("value", "shown"), [(0.0, "0"), (-0.5, "−0.500000"), (2e7, "2.00000e+07")])
def test_a_zero_has_no_zeros_behind_it(value, shown):
    assert number(value, "#.6g") == shown


@pytest.mark.parametrize(
    ("value", "form", "shown"),
    [(155.0, ".2g", "160"), (-12.0, ".1g", "−10"), (2e7, ".2g", "2e+07"), (155.0, ".1e", "1.6e+02")],
)
def test_an_exponent_is_for_large_numbers(value, form, shown):
    assert number(value, form) == shown


def test_details_are_in_the_files_only():
    table = Table("", (Column("a"), Column("b", detail=True)), (("x", "y"),))
    assert "b" not in " ".join(text_of(table, None))
    assert "b" in table.to_csv() and "b" in table.to_markdown()
