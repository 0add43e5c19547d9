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


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("integrator", "step", "tolerance", "law"),
    [
        ("verlet", 2e-5, 2e-3, {"law": "neo-hookean", "young": YOUNG}),
        ("esdirk", None, 2e-3, {"law": "gent", "shear": 1.7e6, "limit": 20.0}),
        ("generalised-alpha", None, 2e-3, {"law": "yeoh", "c1": 8.5e5, "c2": -1e4, "c3": 300.0}),
        ("midpoint", 5e-5, 1e-9, {"law": "mooney-rivlin", "c1": 7e5, "c2": 1.6e5}),
    ],
)
@pytest.mark.parametrize("damping_time", [0.0, 1e-4])
def test_energy_is_in_balance_at_half_as_long_again(integrator, step, tolerance, law, damping_time):
    """A strip suddenly pulled, beyond 50 % of strain. Verlet's error is of the order of (ω h)²/12 of the
    pulled motion's energy, esdirk's that which it is allowed; midpoint's is that of its equations."""
    load = {"kind": "edge", "edge": "x1", "force_per_length": [2400.0, 0.0, 50.0]}
    material = scenes.Material(**law, poisson=0.45, density=1000.0, damping_time=damping_time)
    scene = strip([{"edge": "x0", "kind": "clamped"}], [load], probes={"P3": [0.2, 0.05]})
    scene = scene.replace(material=material)
    calibration = lumped.calibrate(scene.sheet, material, (5, 3), "hyperelastic")
    history = lumped.simulate(
        scene, calibration, duration=0.012, every=1e-3, integrator=integrator, step=step
    )
    assert history.status is Status.CONVERGED
    assert history.probes["P3"][:, 0].max() > 0.5 * 0.2
    energies = {name: values[-1] for name, values in history.energies.items()}
    total = energies["kinetic"] + energies["elastic"] + energies["potential"] + energies["dissipated"]
    assert abs(total) < tolerance * energies["elastic"]
    assert energies["dissipated"] > 0.0 if damping_time else energies["dissipated"] == 0.0


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
