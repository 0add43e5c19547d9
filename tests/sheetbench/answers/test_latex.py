"""Tables in LaTeX: read by a parser of its own, with nothing in them that a plain pdfTeX does not know."""

import unicodedata

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pylatexenc.latexwalker import (
    LatexCharsNode,
    LatexCommentNode,
    LatexEnvironmentNode,
    LatexGroupNode,
    LatexMacroNode,
    LatexMathNode,
    LatexSpecialsNode,
    LatexWalker,
)

from sheetbench.answers.latex import latex
from sheetbench.answers.table import Column, Table

COMMANDS = r"""
textbackslash textasciicircum textasciitilde textasciigrave dots frac times cdot pm ge le approx ne to infty
surd partial nabla propto circ mu alpha beta gamma delta varepsilon zeta eta theta iota kappa lambda nu xi pi
rho sigma tau varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega & % $ # _ { } | \
toprule midrule bottomrule
"""
KNOWN = set(COMMANDS.split())


def rows(text, columns):
    """The cells of a tabular, as LaTeX splits them. Fails where pdfTeX would stop."""
    nodes, *_ = LatexWalker(text, tolerant_parsing=False).get_latex_nodes()
    (tabular,) = [node for node in nodes if isinstance(node, LatexEnvironmentNode)]
    assert tabular.environmentname == "tabular"
    found: list[list[str]] = [[""]]
    for node in tabular.nodelist[1:] if isinstance(tabular.nodelist[0], LatexGroupNode) else tabular.nodelist:
        _known(node)
        if isinstance(node, LatexMacroNode) and node.macroname in ("\\", "toprule", "midrule", "bottomrule"):
            taken = node.nodeargd.argnlist if node.nodeargd else []
            assert not any(taken), "a rule or the end of a row takes a cell for its argument"
            if node.macroname == "\\":
                found.append([""])
        elif isinstance(node, LatexSpecialsNode) and node.specials_chars == "&":
            found[-1].append("")
        else:
            found[-1][-1] += node.latex_verbatim()
    assert not "".join(found.pop()).strip()
    assert all(len(row) == columns for row in found)
    return found


def _known(node):
    assert not isinstance(node, LatexCommentNode)
    if isinstance(node, LatexMacroNode):
        assert node.macroname in KNOWN, node.macroname
    if isinstance(node, LatexMathNode):
        assert node.displaytype == "inline"
    if isinstance(node, LatexCharsNode):
        for character in node.chars:
            parts = unicodedata.normalize("NFD", character)
            assert character.isascii() or parts[0].isascii() or character in "ßøØæÆœŒłŁ", character
    for inner in getattr(node, "nodelist", None) or ():
        _known(inner)


@settings(max_examples=10)
@given(st.lists(st.tuples(st.text(max_size=20), st.text(max_size=20)), min_size=1, max_size=4), st.text())
def test_whatever_stands_in_cells_the_table_reads(cells, caption):
    table = Table(caption, (Column("a_b", "m", "mm"), Column("100 %")), tuple(cells))
    assert len(rows(table.to_latex(), 2)) == 1 + len(cells)


@pytest.mark.parametrize(
    "cell", ["[2 mm]", "*", "--lumped", "10⁻¹⁰", "$α$", "中文 é ß", "<script>|\"`'", "%", "\\\\ & x"]
)
def test_cells_that_latex_would_take_for_its_own(cell):
    table = Table("", (Column("first"), Column("E [Pa]")), ((cell, cell), (cell, "")))
    assert len(rows(table.to_latex(), 2)) == 3


def test_signs_are_signs():
    assert latex("−1 × 10⁻³ – ρ g a/E ≥ ν") == r"$-$1 $\times$ 10$^-${}$^3$ -- $\rho$ g a/E $\ge$ $\nu$"
    assert latex("--lumped 9–17") == "-{}-lumped 9--17"
    assert latex("中") == "{[}U+4E2D{]}"
