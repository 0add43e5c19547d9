"""How the sheet's mass and its payloads are shared out: exact moments, and frequencies on many supports."""

from dataclasses import replace

import numpy as np
import pytest
from cases import sheet

import lumped
from lumped.lattice import build
from lumped.masses import mass_matrix, masses, sheet_masses
from lumped.payloads import point_masses, rotary_masses
from lumped.statics.solver import build_problem
from sheetbench.scenes import Material, Scene, Sheet
from sheetbench.scenes.objects.grading import through
from studies.transfer.scenes import transfer_scenes

SHEET = Sheet(length_x=0.2, length_y=0.3, thickness=0.002)
SCENE = Scene(name="free", sheet=SHEET, material=Material(young=1e6, poisson=0.3, density=1000.0))
EVERY = frozenset({"x0", "x1", "y0", "y1"})

# The first six [Hz] of Habibi et al.'s sheet on the supports of the transfer study, by a Mindlin plate of 32
# × 32 graded elements (fem_reference.modes, model="plate"; 24 × 24 are within 0.01 %, 48 × 48 lower by 0.003
# % at most with opposite edges clamped).
PLATE = {
    "one-edge-clamped": (2.7101, 6.0649, 15.8612, 21.0554, 22.5878, 39.8155),
    "two-edges-clamped": (5.1650, 17.5025, 20.8228, 35.7308, 47.4661, 51.5748),
    "opposite-edges-clamped": (17.3316, 19.9020, 33.2287, 47.6736, 51.1467, 62.1809),
    "three-edges-clamped": (18.4686, 31.0555, 49.0069, 60.3316, 62.5625, 90.7597),
    "opposite-edges-hinged": (7.3174, 11.5318, 27.7526, 30.0896, 34.8341, 53.1842),
    "four-edges-hinged": (15.7135, 39.2885, 39.2885, 62.6349, 78.4626, 78.4660),
}
# Worst of the six [%] at 9 × 9 and at 17 × 17 masses: tributary (measured), higher-order (held).
WORST = {
    "one-edge-clamped": ((5.63, 1.61), (0.8, 0.27)),
    "two-edges-clamped": ((5.18, 1.53), (0.7, 0.29)),
    "opposite-edges-clamped": ((7.89, 2.36), (1.4, 0.56)),
    "three-edges-clamped": ((5.38, 1.59), (1.62, 0.41)),
    "opposite-edges-hinged": ((4.79, 1.41), (0.65, 0.25)),
    "four-edges-hinged": ((1.78, 0.59), (1.55, 0.37)),
}


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", PLATE)
def test_six_frequencies_on_six_supports(name):
    """Within 1.6 % at 9 × 9 × 2 and 0.55 % at 17 × 17 × 2 (the fifth with opposite edges clamped, 0.543);
    tributary masses are up to 7.9 and 2.4 % off."""
    scene = transfer_scenes()[name]
    for n, was, held in zip((9, 17), *WORST[name], strict=True):
        springs = lumped.calibrate(scene.sheet, scene.material, n)
        found = [lumped.modes(scene, springs, 6, kind).frequencies for kind in ("tributary", None)]
        tributary, corrected = (100.0 * float(np.abs(f / PLATE[name] - 1.0).max()) for f in found)
        assert corrected < held
        assert tributary == pytest.approx(was, abs=0.05)


@pytest.mark.parametrize("grading", [0.0, 0.6])
@pytest.mark.parametrize("layers", [2, 3])
def test_moments_of_the_mass(layers, grading):
    """Products of linear motions are integrated exactly, on uneven cells too, and rotary inertia is the
    sheet's however far apart layers are. Tributary masses have a second moment l²/(2 L²) too large."""
    lattice = build(SHEET, (5, 6, layers), 0.003, twisting=EVERY, grading=grading)
    found = mass_matrix(SCENE, lattice, "higher-order").toarray()
    mass, (a, b) = 1000.0 * 0.2 * 0.3 * 0.002, SHEET.lengths
    x, y, z = lattice.positions.T
    one = np.ones_like(x)
    expected = ((one, one, 1.0), (one, x, a / 2), (y, one, b / 2), (x, x, a**2 / 3), (x * y, one, a * b / 4))
    expected = (*expected, (z, one, 0.0), (z, z, 0.002**2 / 12))
    for f, g, value in (*expected, (x * y, x * y, a**2 * b**2 / 9)):
        assert f @ found @ g == pytest.approx(mass * value, rel=1e-12, abs=1e-18)
    assert np.allclose(found, found.T) and np.linalg.eigvalsh(found)[0] > 0.0
    lumps = masses(SCENE, lattice)
    assert lumps @ x**2 > mass * a**2 / 3


@pytest.mark.parametrize("grading", [0.0, 0.6])
def test_a_free_edge_has_the_inertia_of_a_slope_at_the_first_inner_line(grading):
    """f = 1 and g = x² show it, whose l²/12 [(f g)′] is nothing at x = 0: taken l inside it is l³/6 too much,
    and l³/12 by the difference quotient, which a hinge has."""
    hinges = Scene.model_validate({**SCENE.model_dump(), "supports": [{"edge": "x0", "kind": "hinged"}]})
    lattice = build(SHEET, (7, 4, 2), 0.003, twisting=EVERY, grading=grading)
    x = lattice.positions[:, 0]
    free, hinged = (
        np.ones_like(x) @ mass_matrix(scene, lattice, "higher-order") @ x**2 for scene in (SCENE, hinges)
    )
    first = float(lattice.lines[0].widths[0])
    assert free - hinged == pytest.approx(1000.0 * 0.002 * 0.3 * first**3 / 12.0, rel=1e-9)


def test_edges_that_hold_the_director_share_nothing():
    """Nor do layers at h/√3, whose rotary inertia is the sheet's."""
    lattice = build(SHEET, (5, 6, 2), 0.002 / np.sqrt(3.0), twisting=frozenset())
    found = mass_matrix(SCENE, lattice, "higher-order").toarray()
    assert np.allclose(found, np.diag(masses(SCENE, lattice)), rtol=1e-14, atol=1e-18)


@pytest.mark.parametrize("grid", [(2, 2), (2, 5), (3, 3), (4, 3), (9, 3)])
def test_few_masses_keep_a_positive_inertia(grid):
    for at in ((), (0.07,), (0.02, 0.09), (0.1, 0.12)):  # narrow cells beside wide ones, at ends too
        lattice = build(SHEET, (*grid, 2), 0.002, twisting=EVERY, grading=through((at, ()), SHEET.lengths))
        assert np.linalg.eigvalsh(mass_matrix(SCENE, lattice, "higher-order").toarray())[0] > 0.0


def test_springs_fitted_to_frequencies_keep_their_masses():
    springs = lumped.calibrate(SHEET, SCENE.material, 5)
    assert lumped.usual_masses(springs) == "higher-order"
    assert lumped.usual_masses(replace(springs, masses="gregory")) == "gregory"


@pytest.mark.parametrize(("supports", "distribution"), [((), "gregory"), (("x0",), "tributary")])
def test_a_free_sheet_falls_flat_and_a_held_one_weighs_what_its_cells_do(supports, distribution):
    """The weight is of the masses that move, or of those around each; at a clamp the latter are exact."""
    clamps = [{"kind": "clamped", "edge": edge} for edge in supports]
    scene = SCENE.replace(gravity={"acceleration": (0.0, 0.0, -9.81)}, supports=clamps)
    problem = build_problem(scene, lumped.calibrate(SHEET, scene.material, 5))
    weighed = masses(scene, problem.assembly.lattice, distribution)
    assert problem.loads.dead[:, 2] == pytest.approx(-9.81 * weighed)


SIDE, YOUNG, DENSITY = 1.0, 1e9, 1000.0
# ω a² √(ρh/D), converged thin plate, ν = 0.3 (Leissa 1973 set-ups)
CANTILEVER = [3.471, 8.507, 21.28, 27.20, 30.95, 54.18]
TWO_EDGES = [6.919, 23.90, 26.58, 47.64, 62.70, 65.53]


def plate(edges="", thickness=0.0005):
    return sheet(SIDE, SIDE, thickness, YOUNG, 0.3, DENSITY, held=edges)


def parameters(scene, masses, count=6, distribution="tributary"):
    """ω a² √(ρh/D) of the lattice."""
    springs = lumped.calibrate(scene.sheet, scene.material, (masses, masses))
    thickness = scene.sheet.thickness
    rigidity = YOUNG * thickness**3 / 12 / (1 - 0.3**2)
    omega = 2 * np.pi * lumped.modes(scene, springs, count, distribution).frequencies
    return omega * SIDE**2 * np.sqrt(DENSITY * thickness / rigidity)


@pytest.mark.parametrize(("edges", "right"), [("x0", CANTILEVER), ("x0 y0", TWO_EDGES)])
def test_gregory_masses_cut_the_error_of_coarse_grids(edges, right):
    plain, corrected = (
        np.abs(parameters(plate(edges), 9, distribution=kind) / right - 1)[:3]
        for kind in ("tributary", "gregory")
    )
    assert (corrected < 0.01).all() and corrected.max() < 0.4 * plain.max()


def test_a_free_sheet_has_six_rigid_motions_and_no_spurious_mode():
    scene = plate()
    assert lumped.modes(scene, lumped.calibrate(scene.sheet, scene.material, (9, 9)), 1).rigid == 6
    lowest = parameters(scene, 9, 1, "gregory")[0]
    assert lowest == pytest.approx(13.47, rel=0.02)  # Leissa 1973, free square plate


def test_dense_and_sparse_eigensolvers_agree(monkeypatch):
    """To the rounding of K, ε λ_max/λ of the lowest elastic λ: 2e-9 with an edge clamped, 2e-10 free."""
    scene = plate("x0", thickness=0.005)
    dense = parameters(scene, 9)
    monkeypatch.setattr("sheetbench.numerics.eigenmodes.DENSE", 0)
    assert parameters(scene, 9) == pytest.approx(dense, rel=1e-8)
    springs = lumped.calibrate(scene.sheet, scene.material, (9, 9))
    free = plate(thickness=0.005)
    sparse = lumped.modes(free, springs, 3).frequencies
    monkeypatch.setattr("sheetbench.numerics.eigenmodes.DENSE", 10**6)
    assert sparse == pytest.approx(lumped.modes(free, springs, 3).frequencies, rel=1e-8)


@pytest.mark.parametrize("dense", [600, 0])
def test_a_lattice_gives_every_mode_that_it_has_and_no_more(dense, monkeypatch):
    monkeypatch.setattr("sheetbench.numerics.eigenmodes.DENSE", dense)
    scene = plate("x0")
    springs = lumped.calibrate(scene.sheet, scene.material, (3, 3))
    unknowns = lumped.modes(scene, springs, 1).unknowns
    found = lumped.modes(scene, springs, unknowns).frequencies
    assert len(found) == unknowns and found[0] > 0.0 and (np.diff(found) >= 0.0).all()
    for count in (0, unknowns + 1):
        with pytest.raises(ValueError, match=f"count = {count}: 1 to {unknowns} on this lattice"):
            lumped.modes(scene, springs, count)


PIERCED = {"cutouts": [{"shape": {"circle": {"centre": (0.1, 0.05), "radius": 0.02}}}]}
AT = (0.031, 0.047)
PART = {"circle": {"centre": (0.12, 0.08), "radius": 0.017}}
UNDER = Sheet(0.2, 0.1, 0.003)


def lattice_of(*payloads, grading=0.0, layers=2, **more):
    scene = Scene("a", UNDER, Material(1e7, 0.3, 1e3), masses=payloads, **more)
    grid = (11, 6, layers)
    cells = lumped.sections_of(scene, grid)
    own = {"cells": cells} if cells is not None else {"grading": grading}
    springs = lumped.calibrate(scene.sheet, scene.material, grid=grid, **own)
    problem = lumped.build_problem(scene.replace(supports=[{"edge": "x0", "kind": "clamped"}]), springs)
    return scene, problem.assembly


@pytest.mark.parametrize("payload", [{"at": AT, "mass": 0.02}, {"where": PART, "mass": 0.02}], ids=str)
@pytest.mark.parametrize("kind", [{}, {"grading": 0.7}, PIERCED], ids=["even", "graded", "pierced"])
def test_total_and_first_moment_are_the_payloads(payload, kind):
    scene, assembly = lattice_of(payload, **kind)
    found = point_masses(scene, assembly.lattice)
    centre = AT if "at" in payload else PART["circle"]["centre"]
    if "where" in payload and kind is PIERCED:
        part = scene.masses[0].where.area.intersection(scene.region)
        centre = part.centroid.coords[0]
    assert found.sum() == pytest.approx(0.02, rel=1e-12)
    assert found @ assembly.lattice.positions == pytest.approx([0.02 * c for c in (*centre, 0.0)], rel=1e-9)
    assert not found[assembly.lattice.absent_masses].any()


@pytest.mark.parametrize("distribution", ["tributary", "gregory"])
def test_masses_are_the_sheets_and_the_payloads(distribution):
    scene, assembly = lattice_of({"at": AT, "mass": 0.02}, {"at": (0.2, 0.1), "mass": 0.001})
    whole, own = (of(scene, assembly.lattice, distribution) for of in (masses, sheet_masses))
    assert own.sum() == pytest.approx(1e3 * 0.2 * 0.1 * 0.003)
    assert np.allclose(whole - own, point_masses(scene, assembly.lattice), rtol=0.0, atol=1e-18)
    corner = assembly.lattice.columns()[-1, -1]
    assert (whole - own)[corner] == pytest.approx([0.0005, 0.0005])


@pytest.mark.parametrize("layers", [2, 3])
@pytest.mark.parametrize("turn", np.eye(3), ids="xyz")
def test_a_turn_of_all_masses_has_the_bodys_kinetic_energy(layers, turn):
    """v = ω × x, ½ vᵀ M v = ½ I ω² of x and y, none of the normal z; a shift has none."""
    moments = (3e-6, 2e-6, 5e-6)
    part = {"rectangle": {"x": (0.03, 0.08), "y": (0.02, 0.06)}}
    scene, assembly = lattice_of({"where": part, "mass": 1e-12, "inertia": moments}, layers=layers)
    mass, positions = rotary_masses(scene, assembly.lattice), assembly.lattice.positions
    velocity = np.cross(turn, positions).ravel()
    assert velocity @ (mass @ velocity) == pytest.approx(np.array([*moments[:2], 0.0]) @ turn, abs=1e-18)
    assert np.abs(mass @ np.ones(velocity.size)).max() < 1e-15


def test_drag_and_the_sheets_own_mass_know_no_payload():
    air = {"air": {"drag": 2.0}}
    bare, laden = (lattice_of(*payloads, **air) for payloads in ((), ({"at": AT, "mass": 0.5},)))
    one, other = (lumped.System(scene, lumped.build_problem(scene.replace(
        supports=[{"edge": "x0", "kind": "clamped"}]), lumped.calibrate(UNDER, scene.material, grid=(11, 6))))
        for scene, _ in (bare, laden))  # fmt: skip
    assert np.allclose(one.damping.drag.weights, other.damping.drag.weights)
    assert other.lattice_mass.sum() - one.lattice_mass.sum() == pytest.approx(0.5)
