"""Answers at a prompt and in notebooks: a few lines that say what matters, and ways on to other programs."""

from collections.abc import Callable
from functools import cache
from inspect import isfunction, signature
from typing import Any

import meshio
import numpy as np
import pytest
from fake_solutions import history

import fem_reference
import lumped
import sheetbench as sb
from comparisons.comparison.answer import Comparison
from comparisons.models.spec import Elements, Lattice
from comparisons.modes.answer import Spectra, Spectrum
from comparisons.sweep.solved import Request
from comparisons.tradeoff.answer import Tradeoff
from comparisons.tradeoff.row import TradeoffRow
from sheetbench import scenes
from sheetbench.answers.modes import NaturalModes
from sheetbench.scenes.language import summary

SCENE = scenes.load("two-edges-clamped")
HISTORY = history(np.linspace(0.0, 1.0, 500), {f"P{i}": np.full((500, 3), -1e-3) for i in range(40)})
FREQUENCIES = np.arange(1.0, 60.0)


class Still(NaturalModes):
    def displacement(self, points):
        return np.zeros((len(self.frequencies), len(points), 3))


SPECTRA = Spectra(
    SCENE,
    (Spectrum("lumped", "lumped 5×5×2", {}, 0.1, Still(FREQUENCIES, np.zeros(0), 0, 96)),),
)
ROWS = [
    TradeoffRow(Request(SCENE, spec), "converged", error=error, row={"cost": {"samples": [seconds]}})
    for spec, seconds, error in ((Lattice(3), 2e-3, 4e-3), (Elements("shell", 4), 0.1, 1e-3))
]
TRADEOFF = Tradeoff(SCENE, tuple(ROWS), ROWS[1], 1e-4)


@cache
def springs():
    return lumped.calibrate(SCENE.sheet, SCENE.material, grid=(5, 7))


@cache
def lattice():
    return lumped.solve(SCENE, springs())


@cache
def shell():
    return fem_reference.solve(SCENE, elements=2)


@cache
def both():
    return Comparison(SCENE, (lattice(), shell()))


SAID: dict[str, tuple[Callable[[], Any], list[str]]] = {
    "solution": (lattice, ["lumped 5×7×2 consistent", "converged", "factorisations", "13.", "[mm]", "x0"]),
    "calibration": (springs, ["consistent calibration", "of 5 × 7 × 2 masses", "[N/m]", "D11"]),
    "history": (lambda: HISTORY, ["verlet", "converged", "at 1 s", "−1.000", "and 34 more rows"]),
    "comparison": (both, ["two-edges-clamped", "difference", "status", "converged"]),
    "modes": (lambda: lumped.modes(SCENE, springs(), 3), ["3 modes of the lattice", "[Hz]"]),
    "modes of the shell": (
        lambda: fem_reference.modes(SCENE, elements=2, count=3),
        ["3 modes of shell", "[Hz]"],
    ),
    "spectra": (lambda: SPECTRA, ["two-edges-clamped", "lumped", "[Hz]", "and 53 more rows"]),
    "advice": (lambda: sb.tradeoff(SCENE, tolerance=0.1), ["two-edges-clamped", "Trial solves", "yes"]),
    "tradeoff": (lambda: TRADEOFF, ["Observed orders", "lumped", "100.00", "yes"]),
    "mesh": (lambda: lattice().mesh, ["70 points", "quad", "displacement"]),
    "report": (lambda: both().report(), ["Displacement of the mid-surface", "P4  ", "converged"]),
}


@pytest.mark.parametrize("what", SAID)
def test_answers_say_what_matters_in_a_few_lines(what):
    answer, parts = SAID[what]
    text = repr(answer())
    assert all(part in text for part in parts), text
    if what != "report":
        assert len(text.splitlines()) <= 26


def test_names_cannot_act_on_a_terminal():
    scene = SCENE.model_copy(update={"title": "\x1b[31m"})
    named = Comparison(scene, (lattice(), shell()))
    assert "\x1b" not in repr(named) + repr(named.report())


@pytest.mark.parametrize("solved", [lattice, shell])
def test_a_solution_goes_on_to_pyvista_and_to_files(tmp_path, solved):
    solution = solved()
    grid = solution.to_pyvista()
    assert np.array_equal(grid.points, solution.mesh.points)
    assert np.array_equal(grid["displacement"], solution.mesh.point_data["displacement"])
    assert grid.active_vectors_name == "displacement"
    solution.mesh.save(tmp_path / "answer.vtu")
    read = meshio.read(tmp_path / "answer.vtu")
    assert np.allclose(read.point_data["displacement"], solution.mesh.point_data["displacement"], rtol=1e-15)


def test_a_solution_knows_the_probes_of_its_scene():
    solution = sb.solve(SCENE, grid=3)
    assert list(solution.probes) == list(SCENE.probes)
    at_p4 = solution.displacement(np.array([SCENE.probes["P4"]]))[0]
    assert np.array_equal(solution.displacement("P4"), at_p4)
    assert np.array_equal(solution.probes["P4"], at_p4)
    with pytest.raises(sb.BadInput, match="no probe of this name; known: P1, P2"):
        solution.displacement("P9")


def test_reactions_are_shown_without_rounding():
    named = {"x0": (4.16e-16, -2.0, 0.101), "y0": (0.0, 1e-7, 3.0)}
    kept = {name: force.tolist() for name, force in summary.without_rounding(named).items()}
    assert kept == {"x0": [0.0, -2.0, 0.101], "y0": [0.0, 1e-07, 3.0]}


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (644.0, "640"),
        (6.4e5, "640000"),
        (0.0012345, "0.0012"),
        (1e-4, "0.0001"),
        (3.2e-7, "3.2e−07"),
        (0, "0"),
    ],
)
def test_numbers_in_sentences_have_no_exponent(value, said):
    assert summary.few(value) == said


def test_help_shows_no_addresses_and_no_words_of_the_inside():
    signatures = [str(signature(getattr(sb, name))) for name in sb.__all__ if isfunction(getattr(sb, name))]
    assert len(signatures) > 15
    assert not [text for text in signatures if "0x" in text or "lambda" in text or "'Asked'" in text]
