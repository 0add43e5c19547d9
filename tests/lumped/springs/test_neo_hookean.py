"""The neo-Hookean lattice: closed forms at large strain, moduli at small ones, energy in motion."""

import numpy as np
import pytest

import lumped
from lumped import System, build_problem, step_limit
from lumped.assembly import Assembly
from lumped.statics import validity
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.scenes import Scene

YOUNG, THICKNESS = 5e6, 2e-3
SOFT = {"young": YOUNG, "poisson": 0.45, "density": 1000.0}


def strip(supports, loads=(), **others):
    """200 × 100 × 2 mm of silicone."""
    sheet = {"length_x": 0.2, "length_y": 0.1, "thickness": THICKNESS}
    material = {**SOFT, **others.pop("material", {})}
    tables = {"name": "strip", "sheet": sheet, "material": material, "supports": supports, "loads": loads}
    return Scene.model_validate({**tables, **others})


def lattice(scene, grid=(4, 3), **options):
    return lumped.calibrate(scene.sheet, scene.material, grid=grid, method="hyperelastic", **options)


def test_bending_on_habibis_sheet_is_of_second_order_at_least():
    """uz of the corner P4 with two edges clamped: −13.518 mm by neo-Hookean shells of 8 and 16 elements a
    side. With all shear in the faces on the cells' sides 9 masses are 1.3 % off, and 17 masses 0.3 %."""
    scene = scenes.load("two-edges-clamped")
    errors = []
    for masses in (9, 17):
        found = lumped.solve(scene, lattice(scene, masses)).displacement(np.array([scene.probes["P4"]]))
        errors.append(abs(1e3 * found[0, 2] / -13.518 - 1.0))
    assert errors[0] < 5e-3 and errors[1] < 1e-3


def test_the_largest_frequency_does_not_grow_under_stretch():
    """Upright faces resist their director's turning alone; by the chord's length too it would double."""
    scene = strip([{"edge": "x0", "kind": "clamped"}])
    system = System(scene, build_problem(scene, lattice(scene, (5, 4))))
    x = system.assembly.lattice.positions
    at_rest = step_limit(system, np.zeros_like(x)).frequency
    for across in (2.0**-0.45, 1.0, 2.0):
        u = x * [1.0, across - 1.0, 0.0]
        assert 0.9 * at_rest < step_limit(system, u).frequency < 1.01 * at_rest


def test_midpoint_steps_far_too_long_are_a_status_not_a_traceback():
    """200 % of strain in three steps: numbers overflow, and with dampers in the tangent too."""
    load = {"kind": "edge", "edge": "x1", "force_per_length": [4000.0, 0.0, 0.0]}
    scene = strip([{"edge": "x0", "kind": "clamped"}], [load], material={"damping_time": 2e-4})
    history = lumped.simulate(scene, lattice(scene, (9, 5)), duration=0.02, integrator="midpoint")
    assert history.status is Status.DIVERGED and "at 0 s" in history.message


def test_what_the_law_cannot_do_is_refused_by_name():
    scene = strip([{"edge": "x0", "kind": "clamped"}])
    with pytest.raises(ValueError, match="cannot have area, stretch and shear"):
        scenes.SpringSet.model_validate({**lattice(scene).springs.model_dump(), "area": 1.0})


def test_layers_that_shear_alike_hold_all_the_energy_in_their_mean_stretch():
    """Links along the sides know nothing of a shear along them; layers displaced oppositely have no mean."""
    sheet = scenes.Sheet(length_x=0.1, length_y=0.1, thickness=1e-3)
    assembly = Assembly(
        sheet, lumped.calibrate(sheet, scenes.Material(**SOFT), grid=5, method="hyperelastic")
    )
    points, height = assembly.lattice.positions, assembly.lattice.positions[:, 2:]
    alike = 0.02 * points[:, [1, 0, 2]] * [1.0, 1.0, 0.0]
    for u, share in ((alike, 1.0), (alike * np.sign(height), 0.0)):
        total, elongations = assembly.force(u)[0], np.zeros(len(assembly.links.nodes))
        own = assembly.energies(u)
        assert own["axial"] < 0.01 * own["rubber"] and total > 0.0
        assert validity._stretch_share(assembly, u, elongations, total) == pytest.approx(share, abs=0.01)
