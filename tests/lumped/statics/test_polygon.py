"""Chains of few segments, and segments longer than the cells of the grid."""

import numpy as np
import pytest
from commands import json_of
from scipy.integrate import solve_bvp

import fem_reference
import lumped
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Lattice
from sheetbench.scenes import Scene, load

LENGTH, WIDTH, THICK, YOUNG, CURVATURE, RIGIDITY = 0.2, 0.016, 2e-3, 2e7, 9.0, 3e-3
PER_LENGTH = 1200.0 * WIDTH * THICK + 2 * 0.03  # [kg/m]


def scene(young, segments):
    """The catalogue's actuated edge without weight, of a material and with so many segments."""
    base = load("actuated-edge")
    chain = base.actuators[0].replace(segments=segments)
    material = base.material.replace(young=young)
    return base.replace(material=material, actuators=(chain,), gravity=None)


def bending(asked, solution):
    """Mean curvature [1/m] of the edge with the chain."""
    y = np.linspace(0.0, asked.sheet.length_y, 33)
    edge = np.column_stack([np.full_like(y, asked.sheet.length_x), y])
    return 2.0 * float(np.polyfit(y, solution.displacement(edge)[:, 2], 2)[0])


def bent(asked, cells):
    """The same of a lattice of square cells, so many along the edge; the sentence stands where it should."""
    across = round(cells * asked.sheet.length_x / asked.sheet.length_y)
    solution = lumped.solve(asked, lumped.calibrate(asked.sheet, asked.material, (across + 1, cells + 1, 2)))
    (chain,) = asked.actuators
    assert ("than an elastic rod" in solution.message) == (chain.segments < 6)
    return bending(asked, solution)


@pytest.mark.parametrize(
    "young, length, curvature, stiffness, within",
    [
        (54.5e6, 0.188, 4.0, 0.2, (0.015, 0.005)),
        (545e6, 0.188, 1.0, 0.2, (0.045, 0.012)),
        (545e6, 0.376, 4.0, 0.2, (0.055, 0.012)),
    ],
)
def test_cells_finer_than_segments_hold_nothing_back(young, length, curvature, stiffness, within):
    """Against the shell's rod, which knows no segments, on 16 cells: with four segments 1.1, 3.4 and 4.4 %
    are left, with eight 0.2, 0.9 and 1.0. (Polygons lost 7.7 to 41 % with four.)"""
    asked = scene(young, 8)
    chain = asked.actuators[0].replace(curvature=curvature, bending_stiffness=stiffness)
    asked = asked.replace(sheet=asked.sheet.replace(length_x=length), actuators=(chain,), probes={})
    rod = bending(asked, fem_reference.solve(asked, "shell", elements=8))
    for segments, most in zip((4, 8), within, strict=True):
        fewer = asked.replace(actuators=(chain.replace(segments=segments),))
        assert abs(1.0 - bent(fewer, 16) / rod) < most


def composite_elastica():
    """Tip (x, z) [m] of the inextensible strip and its two rods, clamped level, under their weight:
    (2 EI + E b h³/12) θ'' = w (L − s) cos θ, θ(0) = 0, (2 EI + E b h³/12) θ'(L) = 2 EI κ₀, ν = 0."""
    sheet, weight = YOUNG * WIDTH * THICK**3 / 12.0, PER_LENGTH * 9.81
    whole = 2.0 * RIGIDITY + sheet

    def slopes(s, y):
        return [y[1], weight * (LENGTH - s) * np.cos(y[0]) / whole, np.cos(y[0]), np.sin(y[0])]

    def ends(start, end):
        return [start[0], start[2], start[3], end[1] - 2.0 * RIGIDITY * CURVATURE / whole]

    s = np.linspace(0.0, LENGTH, 101)
    guess = np.array([5.0 * s, np.full_like(s, 5.0), s, 2.5 * s**2])
    found = solve_bvp(slopes, ends, s, guess, tol=1e-10, max_nodes=100_000)
    assert found.success
    return found.y[2:, -1]


@pytest.mark.parametrize(
    "grid", [(25, 3), (37, 3), (49, 3), *(pytest.param(n, marks=pytest.mark.nightly) for n in (9, 17))]
)
def test_a_strip_between_two_chains_is_the_composite_elastica(grid):
    """Of 24 segments each; with cells as long, shorter by halves and by what is no whole number: 0.04, 0.04
    and 0.05 % off. (A polygon's edge: 0.04, 0.79, 3.5; 1.9 and 2.3 on 9 and 17 masses across.)"""
    chain = {"segments": 24, "bending_stiffness": RIGIDITY, "line_density": 0.03, "radius": 0.0015,
             "curvature": CURVATURE, "base": "start"}  # fmt: skip
    strip = Scene(
        name="strip between chains",
        sheet={"length_x": LENGTH, "length_y": WIDTH, "thickness": THICK},
        material={"young": YOUNG, "poisson": 0.0, "density": 1200.0},
        gravity={"acceleration": (0.0, 0.0, -9.81)},
        supports=[{"kind": "clamped", "edge": "x0"}],
        actuators=[{**chain, "edge": edge} for edge in ("y0", "y1")],
    )
    solution = solve(resolve(strip, Lattice(grid=grid)))
    assert solution.balance.holds
    tip = solution.displacement([[LENGTH, 0.0]])[0]
    x, z = composite_elastica()
    assert np.abs(tip - [x - LENGTH, 0.0, z]).max() < 1e-3 * z


def test_it_is_said_before_solving(tmp_path, capsys):
    path = tmp_path / "chain.toml"
    scene(545e6, 4).save(path)
    for verb, key in (("check", "foretold"), ("calibrate", "notes")):
        (said,) = json_of(capsys, verb, str(path))[key]
        assert said.startswith(
            "the chain on x1 has 4 segments: it bends the edge less than an elastic rod would"
        )


def test_one_segment_a_cell_keeps_nothing_back():
    asked = scene(545e6, 8)
    springs = lumped.calibrate(asked.sheet, asked.material, 9)
    solution = lumped.solve(asked, springs)
    assert solution.message == ""
    points = asked.probe_points()
    right = fem_reference.solve(asked, "shell", elements=8).displacement(points)
    assert np.abs(solution.displacement(points) - right).max() < 0.03 * np.abs(right).max()
