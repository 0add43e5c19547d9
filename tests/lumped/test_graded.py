"""Graded grids: lines, springs cell by cell, patch tests, and what must not change."""

import json
from functools import cache

import numpy as np
import pytest
from cases import OBLONG, RUBBER, SHEET, SILICONE, relative
from lattice_cases import dense

import fem_reference
import lumped
from lumped.assembly import Assembly
from lumped.calibration import edge_twist
from lumped.grid_lines import grid_lines
from sheetbench.answers.solution import Status
from sheetbench.scenes import BadInput, Clamped, Patch, PointLoad, Scene, Sheet, SpringSet, load
from sheetbench.scenes.objects.grading import Grading, as_settings

GRADINGS = (0.5, 0.8, Grading(0.6, ("x0",)))
CENTRE, CORNER = -3.7224e-3, -19.835e-3  # of Habibi et al.'s linear sheet: `test_edge_twist`


def assembly_of(grading, grid=(6, 5), method="consistent"):
    return Assembly(OBLONG, lumped.calibrate(OBLONG, SILICONE, grid, method, grading=grading))


def test_lines_are_even_at_0_and_chebyshevs_at_1():
    x, y = grid_lines(OBLONG, (6, 5, 2), 0.0)
    assert np.allclose(x.at, np.linspace(0.0, 0.2, 6)) and np.allclose(y.widths, 0.025)
    x, y = grid_lines(OBLONG, (6, 5, 2), 1.0)
    assert np.allclose(x.at, 0.1 * (1.0 - np.cos(np.pi * np.arange(6) / 5)))
    x, _ = grid_lines(OBLONG, (6, 5, 2), 0.5)
    assert np.array_equal(x.widths, x.widths[::-1]) and x.tributary.sum() == pytest.approx(0.2)
    for wrong in (-0.1, 1.1):
        with pytest.raises(BadInput, match="grading"):
            grid_lines(OBLONG, (6, 5, 2), wrong)


@pytest.mark.parametrize("grading", GRADINGS)
@pytest.mark.parametrize("method", ["consistent-interior", "consistent", "consistent-membrane"])
def test_every_cell_meets_every_modulus(grading, method):
    springs = lumped.calibrate(SHEET, RUBBER, (7, 6), method, grading=grading)
    assert all(abs(row["miss"]) < 1e-9 for row in springs.moduli) and len(springs.moduli) == 10
    assert as_settings(grading).items() <= springs.document().items()


@pytest.mark.parametrize("grading", GRADINGS)
@pytest.mark.parametrize("field", [
    lambda x, y, z: (x * z, 0 * y, -0.5 * x**2),
    lambda x, y, z: (0 * x, y * z, -0.5 * y**2),
    lambda x, y, z: (y * z, x * z, -x * y),
], ids=["bending along x", "bending along y", "twisting"])  # fmt: skip
def test_pure_bending_and_twisting_are_in_equilibrium(grading, field):
    """No inner mass of the flat sheet is left with a force, to the rounding of the stiffness."""
    assembly = assembly_of(grading)
    lattice = assembly.lattice
    u = np.column_stack(field(*lattice.positions.T))
    force = (dense(assembly, assembly.tangent(np.zeros_like(u))) @ u.ravel()).reshape(-1, 3)
    inner = lattice.columns()[1:-1, 1:-1].ravel()
    assert np.abs(force[inner]).max() < 1e-10 * np.abs(force).max()


@cache
def shell_of(young, name):
    """A scene of the catalogue on another material, and the shell's answer at its probes."""
    scene = load(name)
    scene = scene.replace(material=scene.material.replace(young=young))
    return scene, fem_reference.solve(scene, model="shell", elements=16).displacement(scene.probe_points())


@pytest.mark.sweep
@pytest.mark.parametrize(
    "method, young, name, masses_, held",
    [
        ("consistent-interior", 54.5e6, "curved-edge", 9, 0.0092),
        ("consistent-interior", 54.5e6, "curved-edge", 17, 0.0042),
        ("consistent-interior", 5.45e6, "two-edges-clamped", 9, 0.0119),
        ("consistent-interior", 5.45e6, "two-edges-clamped", 17, 0.0006),
        ("consistent", 54.5e6, "curved-edge", 9, 0.0105),
        ("consistent", 54.5e6, "curved-edge", 17, 0.0031),
        ("consistent", 5.45e6, "two-edges-clamped", 9, 0.0156),
        ("consistent", 5.45e6, "two-edges-clamped", 17, 0.0013),
    ],
)
def test_narrow_layers_at_the_edges(method, young, name, masses_, held):
    """Error at the probes against the shell; even grids have 6.5, 1.8, 3.4 and 0.86 %."""
    scene, reference = shell_of(young, name)
    springs = lumped.calibrate(scene.sheet, scene.material, masses_, method, grading=0.5)
    points = scene.probe_points()
    answer = lumped.solve(scene, springs)
    assert answer.status is Status.CONVERGED and answer.settings["grading"] == 0.5
    assert relative(answer.displacement(points), reference) < held


@pytest.mark.parametrize(
    "method, held",
    [
        ("consistent-interior", (6e-3, 1.3e-3)),
        ("consistent", (1.4e-3, 4e-4)),
        ("consistent-membrane", (2.4e-3, 7e-4)),
    ],
)
def test_the_order_of_convergence(method, held):
    scene, errors = load("two-edges-clamped"), []
    for n in (17, 33):
        springs = lumped.calibrate(scene.sheet, scene.material, n, method, grading=0.5)
        found = lumped.solve(scene, springs, linear=True).displacement(scene.probe_points())[:, 2]
        errors.append(max(abs(found[0] - CENTRE), abs(found[3] - CORNER)) / abs(CORNER))
    assert errors[0] < held[0] and errors[1] < held[1]
    assert np.log2(errors[0] / errors[1]) > 1.7


@pytest.mark.parametrize("method", ["consistent-interior", "consistent"])
def test_springs_of_a_scene_file_are_the_calibrations(method):
    """Through JSON and back, every digit; another grading is refused, and other counts of cells."""
    scene = load("one-edge-clamped")
    springs = lumped.calibrate(scene.sheet, scene.material, (5, 6), method, grading=0.7)
    written = json.loads(json.dumps(springs.document()))
    kept = {name: written[name] for name in ("grid", "grading", "masses", "layer_distance")}
    table = SpringSet.model_validate(written["springs"] | kept)
    pasted = scene.model_copy(update={"springs": table})
    again = lumped.given(pasted)
    assert (again.grid, again.grading, again.springs) == (springs.grid, 0.7, springs.springs)
    points = scene.probe_points()
    found = [lumped.solve(pasted, own).displacement(points) for own in (again, springs)]
    assert np.array_equal(*found)
    for grading in (0.0, 0.5):
        with pytest.raises(BadInput, match=r"springs.grading = 0.7.*--grading"):
            lumped.given(pasted, grading=grading)
    cells = table.model_copy(update={"grid": None})
    with pytest.raises(BadInput, match=r"springs.axial.x: 4 rows of 6 cells are needed on 7x5 masses"):
        lumped.given(scene.model_copy(update={"springs": cells}), (7, 5))


def test_a_force_between_masses_and_an_edges_load_keep_their_moments():
    """A point load's work on a bilinear displacement, an edge's load on a linear one, of unequal cells."""
    along = {"kind": "edge", "edge": "x1", "force_per_length": (0.0, 0.0, 2.0)}
    loads = (PointLoad(at=(0.13, 0.031), force=(0.0, 0.0, 1.0)), along)
    scene = Scene("loads", OBLONG, SILICONE, supports=(Clamped(edge="x0"),), loads=loads)
    problem = lumped.build_problem(scene, lumped.calibrate(OBLONG, SILICONE, (6, 5), grading=0.5))
    x, y, _ = problem.assembly.lattice.positions.T
    force = problem.loads.dead[:, 2]
    assert force.sum() == pytest.approx(1.2)
    assert (force * x).sum() == pytest.approx(0.13 + 0.2 * 0.2)
    assert (force * y).sum() == pytest.approx(0.031 + 0.2 * 0.05)
    mid = lumped.MidSurface(problem.assembly.lattice, [[0.13, 0.031], [0.2, 0.1], [0.0, 0.0]])
    assert np.allclose(mid.of(problem.assembly.lattice.positions)[:, :2], [[0.13, 0.031], [0.2, 0.1], [0, 0]])


@pytest.mark.parametrize("grid, degree", [((6, 5, 2), 3), ((4, 3, 2), 2), ((2, 2, 2), 1)])
@pytest.mark.parametrize("grading", [0.0, 0.5])
def test_between_masses_the_surface_is_cubic_where_there_are_lines_for_it(grading, grid, degree):
    """Every product of powers up to that degree, anywhere on the sheet; at a mass its own displacement."""
    springs = lumped.calibrate(OBLONG, SILICONE, grid, "consistent-interior", grading=grading)
    lattice = Assembly(OBLONG, springs).lattice
    points = np.random.default_rng(4).uniform(0.0, OBLONG.lengths, (20, 2))
    for a in range(degree + 1):
        for b in range(degree + 1):
            fields = [(x / 0.1) ** a * (y / 0.1) ** b for x, y in (lattice.positions.T[:2], points.T)]
            found = lumped.MidSurface(lattice, points).of(np.repeat(fields[0][:, None], 3, axis=1))
            assert np.allclose(found, fields[1][:, None], rtol=1e-11, atol=1e-12)
    u = np.random.default_rng(5).standard_normal(lattice.positions.shape)
    columns = lattice.columns().reshape(-1, grid[2])
    at_masses = lumped.MidSurface(lattice, lattice.positions[columns[:, 0], :2]).of(u)
    assert np.allclose(at_masses, u[columns].mean(axis=1), rtol=1e-12, atol=1e-13)


def test_two_free_edges_leave_their_corner_its_twisting_stiffness(monkeypatch):
    """What two edges take of their corner cell's twisting stiffness adds; with less than nothing left there
    the sheet has an unstable equilibrium. Here h/10: 33 × 33 masses at grading 1, and even grids."""
    sheet = Sheet(length_x=0.02, length_y=0.02, thickness=0.01)
    scene = load("two-edges-clamped").replace(sheet=sheet.model_dump(), probes={})

    def verdict():
        springs = lumped.calibrate(sheet, scene.material, 9, "consistent", grading=1.0)
        return lumped.solve(scene, springs).status

    assert verdict() is Status.CONVERGED
    monkeypatch.setattr(edge_twist, "AT_CORNERS", 0.0)
    assert verdict() is Status.UNSTABLE


def test_what_has_no_cell_by_cell_form_is_refused():
    for method in ("uniform", "moduli", "cauchy", "central", "axial", "van-gelder", "lloyd"):
        with pytest.raises(
            BadInput, match=r"grading = 0.5: .*takes no grading; grading goes with 'consistent'"
        ):
            lumped.calibrate(SHEET, RUBBER, 5, method, grading=0.5)
    with pytest.raises(BadInput, match=r"3 layers .* no closed form"):
        lumped.calibrate(SHEET, RUBBER, (9, 9, 3), grading=0.5)
    with pytest.raises(BadInput, match=r"layer_distance = 0.001 m .* no closed form"):
        lumped.calibrate(SHEET, RUBBER, 5, layer_distance=1e-3, grading=0.5)
    springs = lumped.calibrate(SHEET, RUBBER, 5, grading=0.5)
    with pytest.raises(BadInput, match="weights = 'full'"):
        lumped.solve(load("one-edge-clamped"), springs, weights="full")


def test_cells_without_a_closed_form_are_refused_with_what_would_help():
    scene = load("one-edge-clamped")
    firm = scene.replace(
        patches=(Patch(shape={"rectangle": {"x": (0.0, 0.05), "y": (0.0, 0.188)}}, young=9e7),)
    )
    with pytest.raises(BadInput, match=r"^grading = 0\.5: with 3 layers .* distance, or grading 0$"):
        lumped.calibrate(scene.sheet, scene.material, (9, 9, 3), grading=0.5)
    with pytest.raises(BadInput, match=r"^unequal cells: with 3 layers .* without a layer distance$"):
        cells = lumped.sections_of(firm, (9, 9, 3), 0.0)
        lumped.calibrate(firm.sheet, firm.material, (9, 9, 3), cells=cells)
