"""Sheets whose natural curvature acts or changes in motion, and as an input of a linear system."""

import numpy as np
import pytest
from cases import sheet
from lattice_cases import MATERIAL

import lumped
from sheetbench.errors import BadInput
from sheetbench.scenes import Clamped, Curved, FactorTable, Patch, load
from sheetbench.scenes.meaning.parameters import put
from sheetbench.scenes.objects.natural import Natural

RAMP = FactorTable(time=(0.0, 0.1), factor=(0.0, 1.0))
BAND = {"rectangle": {"x": (0.05, 0.1), "y": (0.0, 0.1)}}


def cantilever(natural=None, **more):
    return sheet(0.2, 0.1, 0.002, natural=natural, probes={"tip": [0.2, 0.05]}, **more)


def springs(scene):
    return lumped.calibrate(scene.sheet, scene.material, grid=(5, 3, 2))


def run(scene, integrator, duration=0.2, **options):
    found = lumped.simulate(scene, springs(scene), duration, integrator=integrator, **options)
    assert found.succeeded, found.message
    return found


def test_a_damped_sheet_settles_in_its_natural_shape():
    natural = Natural(curvature=(5.0, 0.0, 0.0))
    scene = cantilever(natural, material=MATERIAL.replace(damping_rate=3.4))
    found = run(scene, "esdirk", 8.0)
    still = lumped.solve(scene, springs(scene)).displacement([[0.2, 0.05]])[0]
    np.testing.assert_allclose(found.probes["tip"][-1], still, atol=1e-3 * np.abs(still).max())
    from_there = run(scene.replace(initial={"shape": "static"}), "esdirk", 0.05)
    assert np.abs(from_there.probes["tip"] - still).max() < 1e-6 * np.abs(still).max()


def test_relaxation_goes_with_a_constant_natural_state_only():
    relaxing = MATERIAL.replace(relaxation=({"share": 0.2, "time": 0.05},))
    scene = cantilever(Natural(curvature=(5.0, 0.0, 0.0)), material=relaxing)
    found = run(scene, "midpoint", 0.05, step=5e-4)
    assert np.abs(found.balance - found.balance[0]).max() < 1e-9 * found.energies["elastic"].max()
    with pytest.raises(BadInput, match="natural: with a history"):
        scene.replace(natural=Natural(curvature=(5.0, 0.0, 0.0), history=RAMP))


def test_a_muscle_is_an_input_of_a_linear_system():
    """At rest it moves what the difference of two equilibria does; so say the derivatives."""
    scene = cantilever(patches=(Patch(shape=BAND, natural=Natural(curvature=(5.0, 0.0, 0.0))),))
    linear = lumped.linearise(scene, springs(scene))
    number = linear.inputs.index("patch1.natural.kxx")
    ends = []
    for k in (4.99, 5.01):
        there = scene.replace(patches=(Patch(shape=BAND, natural=Natural(curvature=(k, 0.0, 0.0))),))
        ends.append(lumped.solve(there, springs(scene)).displacement([[0.2, 0.05]])[0])
    slope = (ends[1] - ends[0]) / 0.02
    np.testing.assert_allclose(linear.jacobian[:, number], slope, rtol=1e-5, atol=1e-9)
    _, by = lumped.Differentiable(scene, springs(scene)).at_points([[0.2, 0.05]], ["patch1.natural.kxx"])
    np.testing.assert_allclose(by["patch1.natural.kxx"][0], slope, rtol=1e-5, atol=1e-9)
    curvatures = ("natural.kxx", "natural.kyy", "natural.kxy")
    assert lumped.linearise(cantilever(Natural())).inputs[-3:] == curvatures


def test_inputs_about_the_flat_sheet_depend_on_no_shape_of_its_supports():
    def flat(curvature, tilt):
        held = Curved(edge="x0", curvature=curvature), Clamped(edge="x1", tilt=tilt)
        scene = sheet(0.2, 0.1, 0.002, supports=held, natural=Natural(curvature=(1.0, 0.0, 0.0)))
        return lumped.linearise(scene, about="flat")

    bent, plain = flat(4.0, 0.2), flat(0.0, 0.0)
    assert {"x0 curvature", "natural.kxx"} <= {*bent.inputs} and bent.inputs == plain.inputs
    assert np.allclose(bent.force, plain.force, rtol=1e-6, atol=1e-9 * np.abs(plain.force).max())


def test_a_muscle_at_rest_has_a_derivative_by_its_growth():
    """Its cells are like all others until it grows."""
    scene, name = load("muscle-bands"), "patch1.natural.exx"
    at = scene.probe_points()
    _, by = lumped.Differentiable(scene).at_points(at, [name])
    up, down = (lumped.solve(put(scene, name, end)).displacement(at) for end in (1e-5, -1e-5))
    slope = (up - down) / 2e-5
    np.testing.assert_allclose(by[name], slope, rtol=0.0, atol=1e-4 * np.abs(slope).max())
