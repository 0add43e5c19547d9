"""What a lattice takes of payloads: total, place and moments of inertia, on any cells."""

import numpy as np
import pytest

import lumped
from lumped.carried import point_masses, rotary_masses
from lumped.masses import masses, sheet_masses
from sheetbench.scenes import Material, Scene, Sheet

PIERCED = {"cutouts": [{"shape": {"circle": {"centre": (0.1, 0.05), "radius": 0.02}}}]}
AT = (0.031, 0.047)
PART = {"circle": {"centre": (0.12, 0.08), "radius": 0.017}}
SHEET = Sheet(0.2, 0.1, 0.003)


def lattice_of(*payloads, grading=0.0, layers=2, **more):
    scene = Scene("a", SHEET, Material(1e7, 0.3, 1e3), masses=payloads, **more)
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
    whole, sheet = (of(scene, assembly.lattice, distribution) for of in (masses, sheet_masses))
    assert sheet.sum() == pytest.approx(1e3 * 0.2 * 0.1 * 0.003)
    assert np.allclose(whole - sheet, point_masses(scene, assembly.lattice), rtol=0.0, atol=1e-18)
    corner = assembly.lattice.columns()[-1, -1]
    assert (whole - sheet)[corner] == pytest.approx([0.0005, 0.0005])


@pytest.mark.parametrize("layers", [2, 3])
@pytest.mark.parametrize("turn", np.eye(3), ids="xyz")
def test_a_turn_of_all_masses_has_the_bodys_kinetic_energy(layers, turn):
    """v = ω × x, ½ vᵀ M v = ½ I ω² of x and y, none of the normal z; a shift has none."""
    moments = (3e-6, 2e-6, 5e-6)
    scene, assembly = lattice_of({"at": AT, "mass": 1e-12, "inertia": moments}, layers=layers)
    mass, positions = rotary_masses(scene, assembly.lattice), assembly.lattice.positions
    velocity = np.cross(turn, positions).ravel()
    assert velocity @ (mass @ velocity) == pytest.approx(np.array([*moments[:2], 0.0]) @ turn, abs=1e-18)
    assert np.abs(mass @ np.ones(velocity.size)).max() < 1e-15


def test_drag_and_the_sheets_own_mass_know_no_payload():
    """The air resists areas, not masses."""
    air = {"air": {"drag": 2.0}}
    bare, laden = (lattice_of(*payloads, **air) for payloads in ((), ({"at": AT, "mass": 0.5},)))
    one, other = (lumped.System(scene, lumped.build_problem(scene.replace(
        supports=[{"edge": "x0", "kind": "clamped"}]), lumped.calibrate(SHEET, scene.material, grid=(11, 6))))
        for scene, _ in (bare, laden))  # fmt: skip
    assert np.allclose(one.damping.drag.weights, other.damping.drag.weights)
    assert other.lattice_mass.sum() - one.lattice_mass.sum() == pytest.approx(0.5)
