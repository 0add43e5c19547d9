"""Payloads in every model: a strip with a body at its tip, at rest, in motion and in modes."""

import numpy as np
import pytest
from cases import calibrated, sheet
from scipy.optimize import brentq

import fem_reference
import lumped
from comparisons.external.bricks import Bricks, forces
from comparisons.external.calculix.model import deck
from comparisons.external.kratos.model import Triangles, problem
from sheetbench.answers.solution import Status
from sheetbench.scenes import Gravity, Material

LENGTH, WIDTH, THICK, YOUNG, DENSITY, TIP = 0.2, 0.02, 0.003, 2e6, 1100.0, 5e-3
BEAM = DENSITY * LENGTH * WIDTH * THICK  # kg
RIGIDITY = YOUNG * WIDTH * THICK**3 / 12.0
REFERENCES = {"plate": 2, "shell": 2, "solid": 2}  # elements across
PART = {"rectangle": {"x": (0.15, 0.2), "y": (0.0, WIDTH)}}


def strip(*masses, young=YOUNG, **more):
    given = {"material": Material(young, 0.0, DENSITY), "masses": masses, "weight": 9.81} | more
    return sheet(LENGTH, WIDTH, THICK, **given)


END = {"rectangle": {"x": (0.95 * LENGTH, LENGTH), "y": (0.0, WIDTH)}}


def body(mass=TIP, at=(LENGTH, WIDTH / 2.0)):
    return {"at": at, "mass": mass}


def turning(moments, where=END):
    """Moments of inertia of a body that weighs nothing."""
    return {"where": where, "mass": 1e-9, "inertia": moments}


def frequencies(scene, model, count=1, **more):
    if model == "lumped":
        return lumped.modes(scene, calibrated(scene, (21, 3)), count, **more).frequencies
    return fem_reference.modes(scene, model, REFERENCES[model], count, **more).frequencies


def closed_form(mass, moment=0.0):
    """First frequency [Hz] of an Euler–Bernoulli cantilever with a body at its tip: the root of its
    characteristic equation; e.g. Blevins, Formulas for Dynamics, 2016, table 4.6."""
    a, b = mass / BEAM, moment / (BEAM * LENGTH**2)

    def characteristic(x):
        s, c, sh, ch = np.sin(x), np.cos(x), np.sinh(x), np.cosh(x)
        bare, moved = 1.0 + c * ch, a * x * (c * sh - s * ch)
        return bare + moved - b * x**3 * (c * sh + s * ch) + a * b * x**4 * (1.0 - c * ch)

    root = brentq(characteristic, 0.1, 1.8755)
    return root**2 / (2.0 * np.pi) * np.sqrt(RIGIDITY / (BEAM * LENGTH**3))


@pytest.mark.parametrize("model", ["lumped", *REFERENCES])
@pytest.mark.parametrize("moment", [0.0, 1e-5])
def test_a_strip_with_a_body_at_its_tip_has_the_beams_first_frequency(model, moment):
    """The moment of inertia takes 3 % off it; at a point the width of the strip gives way a little."""
    found = frequencies(strip(body(), turning((0.0, moment, 0.0))), model)[0]
    assert found == pytest.approx(closed_form(TIP, moment), rel=1e-3)
    assert closed_form(TIP, 1e-5) < 0.975 * closed_form(TIP)


def test_a_body_that_turns_about_the_strip_slows_its_twist_alone():
    """Of the fixed rod with a third of its own inertia and the body's at the end, G J/L the spring."""
    slow = strip(body(), turning((2e-6, 0.0, 0.0)))
    plain, turned = (fem_reference.modes(each, "shell", 4, 4).frequencies for each in (strip(body()), slow))
    spring = YOUNG / 2.0 * WIDTH * THICK**3 / 3.0 * (1.0 - 0.63 * THICK / WIDTH) / LENGTH
    whole = 2e-6 + BEAM * (WIDTH**2 + THICK**2) / 36.0
    twist = turned[np.argmin(np.abs(turned[:, None] - plain).min(axis=1) < 1e-4 * turned)]
    assert turned[0] == pytest.approx(plain[0], rel=1e-6)
    assert twist == pytest.approx(np.sqrt(spring / whole) / (2.0 * np.pi), rel=0.05)
    fine = lumped.modes(slow, calibrated(strip(), (41, 9)), 4).frequencies
    assert np.allclose(fine, turned, rtol=0.02)


def test_a_body_that_turns_with_a_part_has_a_frequency_that_converges():
    """At a point the fourth fell without end, 5.09, 5.07, 4.86 Hz."""
    where = {"rectangle": {"x": (0.084, 0.096), "y": (0.0, 0.012)}}
    scene = sheet(0.15, 0.012, 1.5e-3, 4e6, 0.0, 1100.0, masses=[turning((1e-9, 2e-6, 0.0), where)])
    scene = scene.replace(masses=[*scene.masses, {"at": (0.09, 0.006), "mass": 4e-3}])
    coarse, fine = (fem_reference.modes(scene, "shell", n, count=4).frequencies for n in ((25, 2), (50, 4)))
    assert coarse == pytest.approx(fine, rel=2e-4)
    lattice = lumped.modes(scene, calibrated(scene, (26, 3)), 4).frequencies
    assert lattice[[0, 1, 3]] == pytest.approx(fine[[0, 1, 3]], rel=2e-3)  # the third twists it, 2 cells wide


RUNS = [("lumped", "midpoint"), ("lumped", "esdirk"), ("lumped", "verlet"), "plate", "shell"]


@pytest.mark.sweep(4)
@pytest.mark.parametrize("run", RUNS, ids=str)
def test_a_swing_keeps_its_energy_and_reaches_as_far_as_the_others(run):
    """From the flat sheet the potential energy goes into motion and springs and back; nothing else acts."""
    scene = strip(body(), turning((2e-6, 2e-6, 1e-6)), young=2e8)
    if isinstance(run, tuple):
        history = lumped.simulate(scene, calibrated(scene, (11, 3)), duration=0.2, integrator=run[1])
    else:
        history = fem_reference.simulate(scene, run, 0.2, elements=1)
    energies = {name: np.array(history.energies[name]) for name in ("kinetic", "elastic", "potential")}
    whole = sum(energies.values())
    assert history.status is Status.CONVERGED
    least = 5e-3 if run == ("lumped", "esdirk") else 2e-3  # it interpolates between its steps
    assert np.abs(whole).max() < least * np.ptp(energies["potential"])
    sag = 9.81 * LENGTH**3 / (RIGIDITY * 100.0) * (TIP / 3.0 + BEAM / 8.0)
    lowest = np.min(np.array(history.probes["P3"])[:, 2])
    assert lowest == pytest.approx(-2.0 * sag, rel=0.05)
    assert energies["kinetic"].max() > 0.2 * np.ptp(energies["potential"])


@pytest.mark.parametrize("model", ["lumped", "plate", "shell"])
def test_a_mass_spread_over_a_part_is_a_patch_of_higher_density(model):
    denser = DENSITY + TIP / (0.05 * WIDTH * THICK)
    scenes = strip({"where": PART, "mass": TIP}), strip(patches=[{"shape": PART, "density": denser}])
    found = [frequencies(scene, model, 2) for scene in scenes]
    if model == "lumped":  # whose patches have Gregory's weights, and sheets without others of higher order
        assert np.allclose(*found, rtol=3e-3) and found[0][0] == pytest.approx(found[1][0], rel=1e-3)
    else:
        assert np.allclose(*found, rtol=1e-4)


def test_a_state_space_has_the_body_and_its_weight():
    scene = strip(body(), turning((1e-6, 1e-6, 1e-6)), young=2e8)
    own = calibrated(scene, (11, 3))
    linear = lumped.linearise(scene, own)
    about = lumped.modes(scene, own, 2, "gregory", "deformed").frequencies
    assert linear.state_space(2).frequencies == pytest.approx(about, rel=1e-6)
    more = scene.replace(gravity=Gravity((0.0, 0.0, -9.81 * 1.001)))
    heavy, usual = (
        lumped.solve(each, own).displacement([scene.probes["P3"]])[0, 2] for each in (more, scene)
    )
    by_weight = linear.jacobian[linear.outputs.index("P3 uz"), linear.inputs.index("gravity")]
    assert by_weight == pytest.approx((heavy - usual) / 1e-3, rel=1e-2)


def test_judges_are_given_the_weight():
    scene = strip(body(at=(0.17, 0.013)), {"where": PART, "mass": TIP}, young=2e8)
    bricks = Bricks.of(scene, 2, 2, "edges")
    assert forces(scene, bricks).sum(axis=0) == pytest.approx([0.0, 0.0, -2.0 * TIP * 9.81])
    assert "*CLOAD" in deck(scene, bricks)
    pointed = strip(body(at=(0.17, 0.013)))
    handed = problem(pointed, Triangles.of(pointed.sheet, 2), np.ones(1))["force"]
    assert handed.sum(axis=0) == pytest.approx([0.0, 0.0, -TIP * 9.81])
