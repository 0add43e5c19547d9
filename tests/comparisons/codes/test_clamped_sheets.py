"""Clamped sheets of 33 × 33 nodes of each cell, solved as that mesh, beside a plate of the cell's moduli."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import LinearNDInterpolator
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

import fem_reference
from comparisons.codes.cell import cell_of
from comparisons.codes.coefficients import STIFF, moduli_of, nearest
from fem_reference.surface.materials import Section, section_of
from sheetbench import scenes
from sheetbench.scenes import Clamped, Gravity, Sheet

SCENE = scenes.load("one-edge-clamped")
THICKNESS, WEIGHT, SIDE = SCENE.sheet.thickness, 1e-3, 0.188  # m, N/m²: small displacements
POINTS = np.array([[0.5, 0.5], [0.5, 0.75], [0.75, 0.5], [0.75, 0.75], [0.9, 0.9]])


def deflection(cell, values, edges, size):
    """w at POINTS of a sheet of this size, clamped at y0 and, where edges has it, at x0: nodes on and beyond
    those edges are held, and hinges on them twice as stiff, for they bend half a cell. Along free sides there
    are the elements that lie within."""
    near, solid = 1e-6 * size, bool(cell.bricks)
    parts = [
        (e.places, sum(values[name] * unit for name, unit in e.stiffness.items())) for e in cell.elements()
    ]
    parts = [(p, matrix if solid else matrix[2::3, 2::3]) for p, matrix in parts]
    parts += [(p, None) for p in cell.bricks or cell.triangles]  # their weight
    corners = (
        np.array([[x, y] for x in (-0.2, 1.2) for y in (-0.2, 1.2)]) * size @ np.linalg.inv(cell.periods)
    )
    low, high = np.floor(corners.min(axis=0)), np.ceil(corners.max(axis=0))
    number: dict[tuple[int, ...], int] = {}
    places, rows, columns, entries, weights = [], [], [], [], []

    def held(at):
        return (at[..., 1] <= near[1]) | (("x0" in edges) & (at[..., 0] <= near[0]))

    for i, j in np.ndindex(*(high - low).astype(int)):
        for element, matrix in parts:
            moved = tuple((n, a + i + int(low[0]), b + j + int(low[1])) for n, a, b in element)
            at = cell.at(moved)
            outside = (at[:, :2] > size + near).any() or ("x0" not in edges and (at[:, 0] < -near[0]).any())
            if outside or held(at).all():
                continue
            for place, point in zip(moved, at, strict=True):
                if place not in number:
                    number[place] = len(places)
                    places.append(point)
            own = np.array([number[place] for place in moved])
            if matrix is None:
                sides = at[1:3, :2] - at[0, :2]
                area = cell.area if solid else abs(np.linalg.det(sides)) / 2.0
                weights += [(n, area * WEIGHT / len(own)) for n in own]
                continue
            factor = 2.0 if len(at) == 4 and held(at[:2]).all() else 1.0
            own = (3 * own[:, None] + np.arange(3)).ravel() if solid else own
            rows.append(np.repeat(own, len(own)))
            columns.append(np.tile(own, len(own)))
            entries.append(factor * matrix.ravel())
    nodes, ways = np.array(places), 3 if solid else 1
    count = ways * len(nodes)
    index = (np.concatenate(rows), np.concatenate(columns))
    stiffness = coo_matrix((np.concatenate(entries), index), shape=(count, count)).tocsr()
    force, found = np.zeros(count), np.zeros(count)
    np.add.at(force, [ways * n + ways - 1 for n, _ in weights], [-weight for _, weight in weights])
    free = np.repeat(~held(nodes), ways)
    found[free] = spsolve(stiffness[free][:, free].tocsc(), force[free])
    lower = nodes[:, 2] <= 0.0
    return LinearNDInterpolator(nodes[lower, :2], found[ways - 1 :: ways][lower])(POINTS * size)


def off(name, edges, squares):
    """Mesh less plate at POINTS, over the plate's largest."""
    spacing = SIDE / squares
    high = round(squares / 0.75**0.5) * 0.75**0.5 * spacing if name == "equilateral" else SIDE  # whole rows
    cell = cell_of(name, spacing, THICKNESS)
    values = nearest(cell, SCENE.material, THICKNESS)
    got = moduli_of(cell, values)
    shear = STIFF * section_of(SCENE.material, THICKNESS).shear if got.shear is None else got.shear
    acceleration = WEIGHT / SCENE.material.density / THICKNESS
    scene = SCENE.replace(
        sheet=Sheet(length_x=SIDE, length_y=high, thickness=THICKNESS),
        supports=tuple(Clamped(edge=edge) for edge in edges.split()),
        gravity=Gravity(acceleration=(0.0, 0.0, -acceleration)),
        probes={},
    )
    size = np.array([SIDE, high])
    section = Section(got.membrane, got.bending, shear)
    plate = fem_reference.solve(scene, "plate", elements=16, section=section).displacement(POINTS * size)
    return (deflection(cell, values, edges, size) - plate[:, 2]) / np.abs(plate[:, 2]).max()


@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    ("name", "edges"),
    [("one-diagonal", "x0 y0"), ("alternate-diagonals", "x0 y0"), ("bricks", "x0 y0"), ("equilateral", "y0")],
)
def test_clamped_sheets_of_33_nodes_a_side_deflect_as_their_moduli_say(name, edges):
    """Rims are of the order of spacing over side, 3 %, less what cancels there."""
    assert np.abs(off(name, edges, 32)).max() < 0.01


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("name", "edges", "squares"),
    [("unstructured", "y0", 20), ("unstructured", "x0 y0", 40), ("equilateral", "x0 y0", 32)],
)
def test_sheets_clamped_along_ragged_edges_tend_to_their_moduli(name, edges, squares):
    """No line of nodes lies on such an edge: it is held up to half a cell from where the sheet ends, so that
    the difference halves with the cells and two meshes tell the limit."""
    coarse, fine = off(name, edges, squares), off(name, edges, 2 * squares)
    assert np.log2(np.abs(coarse).max() / np.abs(fine).max()) == pytest.approx(1.0, abs=0.3)
    assert np.abs(2.0 * fine - coarse).max() < 0.01
