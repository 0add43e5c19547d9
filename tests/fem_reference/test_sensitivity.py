"""Derivatives of plate and shell beside central differences of equilibria of their own, for every kind of
scene; by elements beside patches; where there are none."""

from time import process_time

import numpy as np
import pytest
from cases import CLAMP, GRAVITY, OBLONG, RUBBER, SILICONE, calibrated, sheet
from numpy.testing import assert_allclose
from rod_cases import chain
from rubbers import rubber

import fem_reference
import lumped
from fem_reference import sheets
from fem_reference.discrete import tangent_planes
from fem_reference.discrete.answer import trace_sheet
from fem_reference.discrete.static import Static, StaticState
from fem_reference.sensitivity import FIELD, SheetSensitivity
from sheetbench.answers.solution import Status
from sheetbench.errors import Impossible, NoEquilibrium
from sheetbench.scenes import (
    EDGES,
    Clamped,
    Curved,
    EdgeLoad,
    EdgeMotion,
    Hinged,
    Layer,
    Mass,
    Material,
    Patch,
    Plane,
    PointLoad,
    Pressure,
    Scene,
    Sphere,
    Symmetric,
    load,
)
from sheetbench.scenes.meaning.parameters import parameter, put
from sheetbench.scenes.objects.natural import Natural
from sheetbench.scenes.objects.shapes import Rectangle, Shape
from sheetbench.scenes.objects.supports import Motion

LEFT = Shape(rectangle=Rectangle(x=(0.0, 0.1), y=(0.0, 0.1)))
FIBRES = {"young_1": 4e7, "young_2": 8e6, "poisson_12": 0.25, "shear_12": 5e6, "density": 1200.0}
WOVEN = Material(kind="orthotropic", angle=0.4, shear_23=3e6, **FIBRES)
PLIES = Layer(thickness=0.002, angle=0.3), Layer(thickness=0.003, young=3e7, poisson=0.3, density=900.0)
TURN = EdgeMotion(
    kind="motion", edge="x1", time=(0.0,), displacement=((0, 0, 0.02),), rotation=((0.1, 0.3, 0),)
)
PULL = Motion(time=(0.0, 1.0), displacement=((0, 0, 0), (0.1, 0, 0.01)))


def oblong(material=SILICONE, gravity=GRAVITY, supports=(CLAMP,), **more):
    return Scene(name="s", sheet=OBLONG, material=material, gravity=gravity, supports=supports, **more)


def pulled(material):
    """To a stretch of 1.5."""
    ends = Clamped(edge="x0"), Hinged(edge="x1", motion=PULL)
    return oblong(material, supports=ends, loads=(Pressure(value=300.0),))


SPATIAL = {"curvature": tuple(range(-3, 8)), "segments": 12, "plane": "spatial", "face": "top"}
SLOPE = Plane(position=(0.0, 0.0, -0.03), normal=(0.1, 0.0, 1.0))
BALL = Sphere(position=(0.1, 0.04, -0.033), radius=0.03)
SCENES = {
    "plain": oblong(loads=(PointLoad(at=(0.17, 0.03), force=(0.02, 0.1, -0.1)),)),
    "fibres": oblong(WOVEN),
    "laminate": oblong(WOVEN, layers=PLIES),
    "holes": load("kirigami-strip"),
    "chain": oblong(actuators=(chain(**SPATIAL),)),
    "natural": oblong(
        natural=Natural(strain=(0.02, 0.0, 0.01), curvature=(2.0, -1.0, 0.5)),
        patches=(Patch(shape=LEFT, thickness=0.004, natural=Natural(curvature=(1.0, 2.0, 0.0))),),
    ),
    "pretension": oblong(
        supports=tuple(Hinged(edge=edge) for edge in ("x0", "x1", "y0")),
        natural=Natural(pretension=(20.0, 10.0)),
    ),
    "heat": load("bimetal-strip"),
    "mooney-rivlin": pulled(rubber("mooney-rivlin")),
    "yeoh": pulled(rubber("yeoh")),
    "gent": pulled(rubber("gent")),
    "neo-hookean": pulled(rubber("neo-hookean")),
    "ball": oblong(RUBBER.replace(young=2e6), obstacles=(BALL,)),
    "plane": oblong(RUBBER.replace(young=2e6), obstacles=(SLOPE,)),
    "pressure": oblong(
        gravity=None,
        loads=(Pressure(value=100.0), EdgeLoad(edge="x1", moment_per_length=0.2, force_per_length=(0, 1, 0))),
    ),
    "moved": oblong(actuators=(TURN,)),
    "payload": oblong(masses=(Mass(mass=0.02, at=(0.15, 0.08)), Mass(mass=0.05, where=LEFT))),
    "tilted": oblong(supports=(Clamped(edge="x0", tilt=0.3), Symmetric(edge="y0"))),
    "bent": oblong(supports=(Curved(edge="x0", curvature=3.0),)),
}  # fmt: skip
LINEAR = ("plain", "laminate", "natural", "pressure", "moved", "bent", "payload")
ROWS = [*((name, "shell") for name in SCENES), *((name, "plate") for name in LINEAR)]
TOUCHING = ("ball", "plane")


def at_rest(sheet, q):
    """An equilibrium to rounding, from one near by."""
    static, state, moved = Static(sheet), StaticState(q), 1.0
    while moved > 1e-13:
        forces = static.forces(state, 1.0)
        matrix, rows = static.linearised(state, forces, 1.0, mixed=False)
        step = sheet.solver().factor(matrix).solve(rows)
        state, before = StaticState(static.advance(state, forces, 1.0, step).q), moved
        moved = np.abs(step).max()
        if moved > 0.5 * before:  # all of it rounding
            break
    return state.q


def sampled(shape, points):
    """What an answer has at plan points: of a sheet on a ball, the surface that touches it."""
    found = shape.sheet.sample(shape.sheet.displacement(shape.q), points)
    if not shape.sheet.touched_without_kinks(shape):
        return found
    return found + tangent_planes.change_at(shape.sheet.plan.mesh, shape.vectors, points)[1]


def sensitivity(scene, model="shell", elements=3):
    division = sheets.division_of(scene, model, elements)
    run = trace_sheet(division.sheet)
    assert run.path.load_factor == 1.0
    return SheetSensitivity(run.sheet, at_rest(run.sheet, run.path.state.q))


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name, model", ROWS)
def test_derivatives_are_those_of_equilibria_found_anew(name, model):
    scene = SCENES[name]
    found = sensitivity(scene, model)
    sheet, points = found.sheet, scene.probe_points()
    weights = np.random.default_rng(1).normal(size=(len(points), 3))
    gradient = found.at_points(points, weights)
    own = () if sheet.linear else (sheet.law,)

    def j(scene):
        other = type(sheet)(sheet.plan.mesh, scene, None, *own)
        return np.sum(weights * sampled(other.shape(at_rest(other, found.shape.q), 1.0), points))

    names = [name for name in gradient if not name.startswith(FIELD)]
    assert len(names) >= 4
    by, differences, scales = [], [], []
    for one in names:
        value = parameter(scene, one).value
        scales.append(abs(value) or 0.1)
        step = (1e-6 if name in TOUCHING else 1e-4) * scales[-1]
        near, far = (
            j(put(scene, one, value + k * step)) - j(put(scene, one, value - k * step)) for k in (1, 2)
        )
        differences.append((8.0 * near - far) / (12.0 * step))
        by.append(gradient[one])
    by, differences = scales * np.array(by), scales * np.array(differences)
    assert_allclose(by, differences, rtol=0.0, atol=1e-6 * np.abs(by).max())
    shares = np.random.default_rng(2).normal(size=len(names))
    moved = found.pushforward(dict(zip(names, shares * scales, strict=True)))
    if name != "ball":
        assert np.sum(weights * sheet.sample(moved, points)) == pytest.approx(shares @ by, rel=1e-6)
    moved = [np.sum(weights * found.displacement_rate(points, one)) for one in names]
    assert_allclose(scales * np.array(moved), by, rtol=0.0, atol=1e-6 * np.abs(by).max())


def test_all_derivatives_take_one_factorisation_and_no_solve(monkeypatch):
    scene, factored, factor = load("one-edge-clamped"), [], SheetSensitivity._factor
    answer = fem_reference.solve(scene, "shell", elements=4)
    monkeypatch.setattr(SheetSensitivity, "_factor", lambda *at: factored.append(at) or factor(*at))
    monkeypatch.setattr("fem_reference.discrete.answer.trace_sheet", None)
    gradient = dict(answer.sensitivity().at_points(scene.probe_points()[-1:], np.eye(3)[2:]))
    assert len(gradient) >= 10 and len(factored) == 1


@pytest.mark.nightly  # a ratio of times
def test_value_and_derivatives_cost_less_than_two_solves_and_a_third():
    """The shell of 8: all numbers and fields of an answer, in the same process."""
    scene, costs = load("one-edge-clamped"), []
    for _ in range(5):
        begin = process_time()
        answer = fem_reference.solve(scene, "shell", elements=8)
        solved = process_time()
        gradient = dict(answer.sensitivity().at_points(scene.probe_points()[-1:], np.eye(3)[2:]))
        costs.append((solved - begin, process_time() - begin))
    assert len(gradient) >= 10 and gradient["elements.young"].shape == (64,)
    cold, both = np.min(costs, axis=0)
    assert both <= 2.3 * cold


def test_field_over_a_patch_is_the_patch():
    found = sensitivity(SCENES["natural"])
    gradient = found.at_points([(0.2, 0.1)], [(0.0, 0.0, 1.0)])
    inside = found.centres[:, 0] < 0.1
    over = gradient["elements.thickness"][inside].sum()
    # of a natural strain that is the same at every thickness
    assert gradient["patch1.thickness"] == pytest.approx(over, rel=1e-7)
    every = gradient["elements.young"].sum()
    assert gradient["young"] == pytest.approx(every, rel=1e-7)
    for name, parts in (("strain", "exx eyy exy"), ("curvature", "kxx kyy kxy")):
        natural = gradient[f"elements.{name}"]
        by_patch = [gradient[f"patch1.natural.{part}"] for part in parts.split()]
        outside = [gradient[f"natural.{part}"] for part in parts.split()]
        assert_allclose(by_patch, natural[inside].sum(axis=0), rtol=1e-6)
        assert_allclose(outside, natural[~inside].sum(axis=0), rtol=1e-6)


FREQUENCIES = [("plain", "plate", "flat"), ("laminate", "shell", "flat"), ("payload", "shell", "flat")]
FREQUENCIES += [("plane", "shell", "flat")]  # which is no part of the flat sheet
FREQUENCIES += [(name, "shell", "deformed") for name in ("natural", "payload", "tilted")]


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name, model, about", FREQUENCIES)
def test_derivatives_of_a_frequency_are_differences(name, model, about):
    scene, number = SCENES[name], 3

    def modes(scene):
        return fem_reference.modes(scene, model, elements=3, count=4, about=about)

    gradient, by, differences = modes(scene).sensitivity(number), [], []
    for one in (one for one in gradient if not one.startswith(FIELD)):
        value = parameter(scene, one).value
        scale = abs(value) or 0.1
        near, far = (
            modes(put(scene, one, value + k * 1e-3 * scale)).frequencies[number - 1]
            - modes(put(scene, one, value - k * 1e-3 * scale)).frequencies[number - 1]
            for k in (1, 2)
        )
        differences.append((8.0 * near - far) / 12e-3)
        by.append(scale * gradient[one])
    assert_allclose(by, differences, rtol=0.0, atol=2e-6 * np.abs(by).max())
    # all moduli and the density twice as large leave the frequency what it is, but for a weight's deflection
    assert gradient["elements.density" if scene.layers == () else "elements.1.density"].sum() < 0.0


def test_frequencies_that_coincide_have_no_derivatives():
    edges = tuple(Hinged(edge=edge) for edge in EDGES)
    square = sheet(0.1, 0.1, 0.001, supports=edges)
    found = fem_reference.modes(square, "plate", elements=4, count=4)
    with pytest.raises(Impossible, match="2 and 3 coincide"):
        found.sensitivity(2)
    assert found.sensitivity(1)["young"] > 0.0
    with pytest.raises(Impossible, match="1 to 3"):
        found.sensitivity(4)


def test_a_cantilever_softens_as_the_closed_form_says():
    """u = 4 F L³/(E b h³): d ln u/d ln E = −1, d ln u/d ln h = −3, d ln u/d ln F = 1; on the lattice too."""
    pull = EdgeLoad(edge="x1", force_per_length=(0.0, 0.0, -1e-4))
    strip = sheet(0.2, 0.02, 0.001, poisson=0.0, loads=(pull,), probes={"P": (0.2, 0.01)})
    answer = fem_reference.solve(strip, "shell", elements=2)
    gradient = answer.sensitivity().at_points([(0.2, 0.01)], [(0.0, 0.0, 1.0)])
    u = answer.displacement([(0.2, 0.01)])[0, 2]
    names = {"young": (1e6, -1.0), "thickness": (0.001, -3.0), "load1.force_per_length.z": (-1e-4, 1.0)}
    for name, (value, power) in names.items():
        assert gradient[name] * value / u == pytest.approx(power, abs=2e-3)
    lattice = lumped.Differentiable(strip, calibrated(strip, (41, 5)))
    u, derivatives = lattice.at_points([(0.2, 0.01)], ["young", "thickness"])
    for name, by in derivatives.items():
        assert by[0, 2] * names[name][0] / u[0, 2] == pytest.approx(names[name][1], abs=2e-3)


def test_unstable_equilibria_have_no_derivatives_and_solids_none():
    push = EdgeLoad(edge="x1", force_per_length=(-0.6, 0.0, 0.0))  # three times Euler's π²EI/4L²
    column = sheet(1.0, 0.1, 0.01, loads=(push,))
    answer = fem_reference.solve(column, "shell", elements=2)
    assert answer.status is Status.UNSTABLE
    with pytest.raises(NoEquilibrium, match="unstable"):
        answer.sensitivity()
    assert fem_reference.solve(SCENES["plain"], "solid", elements=2).sensitivity is None
