"""Derivatives of the lattice, forward and adjoint, against differences of whole solutions."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest
from cases import calibrated, sheet, with_material
from contact_cases import bent_over

import lumped
from lumped.calibration import default
from lumped.gradient import Base, Equilibrium
from lumped.statics.build import build_problem
from lumped.statics.solver import solve_path
from sheetbench import scenes
from sheetbench.errors import BadInput, NoEquilibrium
from sheetbench.scenes import Clamped, EdgeLoad, Hinged, Mass, Material, PointLoad, Pressure
from sheetbench.scenes.meaning.natural_state import sheet_at_rest
from sheetbench.scenes.meaning.parameters import parameter, put
from sheetbench.scenes.objects.cutouts import Cutout
from sheetbench.scenes.objects.natural import Natural
from sheetbench.scenes.objects.patches import Patch
from sheetbench.scenes.objects.supports import Motion

GRID = (7, 7)
DRAWN = {
    "sheet": scenes.Sheet(0.188, 0.188, 0.003, taper_x=(0.003, 0.002)),
    "patches": (
        Patch(shape={"circle": {"centre": (0.1, 0.1), "radius": 0.05}}, young=9e7, density=900.0),
        Patch(shape={"rectangle": {"x": (0.0, 0.03), "y": (0.0, 0.188)}}, thickness=0.004, poisson=0.3),
    ),
}
BODY = Mass(at=(0.188, 0.094), mass=5e-3)


def scene_of(name, **changes):
    return scenes.load(name).model_copy(update=changes)


def forward(scene, springs, names):
    """The displacement of the probes and its derivatives by name."""
    return lumped.Differentiable(scene, springs).at_points(scene.probe_points(), names)


def assert_close(mine, theirs, within=2e-5):
    assert np.abs(theirs).max() > 0.0
    assert np.abs(mine - theirs).max() < within * np.abs(theirs).max()


@pytest.mark.parametrize("grid", [(7, 7), (5, 9)])
def test_every_spring_constant(grid):
    scene = scene_of("two-edges-clamped")
    springs = calibrated(scene, grid)
    names = [*springs.constants.names(), "layer_distance"]
    assert len(names) >= 8
    u, found = forward(scene, springs, names)
    for name in names:
        value = springs.constants.value(name)
        up, down = (
            lumped.solve(scene, springs.with_constant(name, value + h)).displacement(scene.probe_points())
            for h in (1e-4 * value, -1e-4 * value)
        )
        expected = (up - down) / (2e-4 * value)
        scale = np.abs(u).max() / abs(value)
        assert np.abs(found[name] - expected).max() < 2e-7 * scale, name


def test_at_a_bound_the_difference_is_one_sided():
    slopes = []
    for poisson in (0.4999, 0.4999 - 1e-3):
        scene = with_material(scene_of("one-edge-clamped"), poisson=poisson)
        slopes.append(forward(scene, calibrated(scene, 3), ["poisson"])[1]["poisson"])
    assert_close(*slopes, within=1e-2)


def test_the_tilt_of_one_of_two_clamps_that_share_a_corner_is_refused():
    scene = scene_of("two-edges-clamped")
    with pytest.raises(ValueError, match=r"tilt_x0.*corner"):
        forward(scene, calibrated(scene, GRID), ["tilt_x0"])


def test_springs_of_a_changed_scene_have_the_options_of_its_own():
    scene = scene_of("one-edge-clamped", cutouts=(Cutout(shape=HOLE),), probes={"P": (0.188, 0.18)})

    def springs_of(scene):
        springs = lumped.calibrate(scene.sheet, scene.material, 5, "uniform", k=3e4)
        return lumped.with_shares(springs, scene.sheet, scene.material, lumped.sections_of(scene, (5, 5, 2)))

    _, found = forward(scene, springs_of(scene), ["young", "thickness"])
    assert not found["young"].any()
    ends = (put(scene, "thickness", h) for h in (3.0003e-3, 2.9997e-3))
    up, down = (lumped.solve(one, springs_of(one)).displacement(scene.probe_points()) for one in ends)
    assert_close(found["thickness"], (up - down) / 6e-7, within=1e-6)


def test_cells_under_pretension_have_derivatives_by_their_thickness():
    held = tuple(Hinged(edge=edge) for edge in ("x0", "x1", "y0"))
    scene = scene_of("one-edge-clamped", supports=held, natural=Natural(pretension=(20.0, 10.0)))
    springs = lumped.calibrated_at_rest(scene, lambda sheet: lumped.calibrate(sheet, scene.material, 5))
    of, h = lumped.Differentiable(scene, springs), 1e-4
    found = np.sum(of.pullback(np.ones((50, 3)))["cells.thickness"] * of.base["cells.thickness"])
    up, down = (of.solve({"cells.thickness": of.base["cells.thickness"] * n}).sum() for n in (1 + h, 1 - h))
    assert found == pytest.approx((up - down) / (2.0 * h), rel=1e-6)


FIBRES = {"young_1": 2e7, "young_2": 1e6, "poisson_12": 0.3, "density": 1000.0, "angle": 0.4}
FIBRES |= dict.fromkeys(("shear_12", "shear_13", "shear_23"), 5e5)
HOLE = {"circle": {"centre": (0.1, 0.1), "radius": 0.031}}
MOVED = Motion(time=(0.0, 1.0), displacement=((0.0, 0.0, 0.0), (0.01, 0.0, 0.02)))
STRETCHED = (EdgeLoad(edge="x1", force_per_length=(4000.0, 0.0, 100.0)),)


def oblong(**material):
    return sheet(0.2, 0.1, 0.002, material=Material(poisson=0.45, density=1e3, **material), loads=STRETCHED)


def curled(**natural):
    return scene_of("one-edge-clamped", natural=Natural(**natural))


TWELVE = {
    "fibres": lambda: scene_of("one-edge-clamped", material=Material(kind="orthotropic", **FIBRES)),
    "laminate": lambda: scene_of("bimetal-strip"),
    "hole": lambda: scene_of("one-edge-clamped", cutouts=(Cutout(shape=HOLE),), probes={}),
    "patches": lambda: scene_of("one-edge-clamped", **DRAWN),
    "edge moment": lambda: scene_of(
        "curved-edge", gravity=None, loads=(EdgeLoad(edge="x1", moment_per_length=0.2),)
    ),
    "chain": lambda: scene_of("actuated-edge"),
    "natural": lambda: curled(strain=(0.02, 0.01, 0.005), curvature=(3.0, 1.0, 0.5)),
    "rubber": lambda: oblong(law="neo-hookean", young=5e6),
    "gent": lambda: oblong(law="gent", shear=2e6, limit=30.0),
    "contact": lambda: bent_over(),
    "pressure": lambda: scene_of("one-edge-clamped", loads=(Pressure(value=30.0),)),
    "moved supports": lambda: scene_of(
        "two-edges-clamped", supports=(Clamped(edge="x0"), Clamped(edge="x1", motion=MOVED))
    ),
    "payload": lambda: scene_of(
        "one-edge-clamped", masses=(BODY,), loads=(PointLoad(at=(0.15, 0.05), force=(0.0, 0.02, 0.1)),)
    ),
    "graded, tilted": lambda: scene_of("one-edge-clamped", supports=(Clamped(edge="x0", tilt=0.4),)),
}


NIGHTLY = {"contact": pytest.mark.nightly}  # a minute


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", [pytest.param(name, marks=NIGHTLY.get(name, ())) for name in TWELVE])
def test_gradients_of_twelve_scenes_are_those_of_differences(name):
    scene, graded = TWELVE[name](), 0.5 if name.startswith("graded") else 0.0
    known = name in ("chain", "contact") or scene.material.law is not None

    def springs_of(scene):
        return (
            default(scene) if known else calibrated(scene.replace(sheet=sheet_at_rest(scene)), GRID, graded)
        )

    springs = springs_of(scene)
    problem = build_problem(scene, springs)
    of = lumped.Differentiable(scene, springs)
    rng = np.random.default_rng(0)
    masses = problem.assembly.lattice.mass_count
    of.solve({})
    weights = np.zeros_like(problem.loads.dead)
    weights[:masses] = rng.standard_normal((masses, 3))
    found, before = of.pullback(weights), of.base
    moved = {"cells.strain": 1e-5, "cells.curvature": 1e-3, "forces": 1e-5}
    refused = ["cells.thickness", "cells.poisson"] if scene.material.law else []
    refused += ["cells.poisson"] if scene.material.kind == "orthotropic" or scene.layers else []

    def slope(key, base, way, h):
        ends = [of.solve({key: base + n * h * way}) for n in (1, -1, 2, -2)]
        one, two = (np.sum(weights * (up - down)) for up, down in (ends[:2], ends[2:]))
        return (8.0 * one - two) / (12.0 * h)

    of.solve({})  # where others begin
    for key, base in before.items():
        if key in refused:
            with pytest.raises(BadInput, match=r"cells\.poisson"):
                found[key]
            continue
        if not base.any() and key not in moved:  # a sheet without a density
            continue
        way = np.zeros(base.shape)
        way.flat[rng.permutation(base.size)[:5]] = 1.0
        way = way * base / np.abs(base).max() if key.endswith(("young", "thickness", "density")) else way
        way[masses:] *= key != "forces"
        expected = slope(key, base, way, moved.get(key, 1e-3 * np.abs(base).max()))
        largest = np.abs(found[key]).max() * np.abs(way).max()
        assert np.sum(found[key] * way) == pytest.approx(expected, rel=1e-6, abs=1e-6 * largest), key
        assert np.sum(weights * forward_of(of, {key: way})) == pytest.approx(
            expected, rel=1e-5, abs=1e-6 * largest
        )
    by, differences = [], []
    for key in [key for key in found if not key.startswith(("cells.", "forces"))]:
        value = parameter(scene, key).value
        scale = abs(value) or 1e-2
        h = 1e-6 if ".e" in key or key.startswith("obstacle") else 1e-4 * scale

        def at(value, key=key):
            """J of a scene that is made, and whose springs are found, anew."""
            changed = put(scene, key, value, checked=False)
            return np.sum(weights * solve_path(build_problem(changed, springs_of(changed))).state.u)

        near, far = (at(value + n * h) - at(value - n * h) for n in (1, 2))
        differences.append(scale * (8.0 * near - far) / (12.0 * h))
        by.append(scale * found[key])
    assert_close(np.array(by), np.array(differences), within=1e-6)


def forward_of(of, changes):
    """At the scene's own values."""
    of.solve({})
    return of.pushforward(changes)


def test_values_of_a_design_go_together():
    """Fields, forces and numbers of the scene at once, of which each has its derivative there."""
    of = lumped.Differentiable("one-edge-clamped")
    rng = np.random.default_rng(1)
    base = of.base
    values = {
        "cells.young": base["cells.young"] * np.exp(0.2 * rng.standard_normal((8, 8))),
        "cells.strain": 0.01 * rng.standard_normal((8, 8, 3)),
        "cells.curvature": 3.0 * rng.standard_normal((8, 8, 3)),
        "forces": 1e-3 * rng.standard_normal(base["forces"].shape),
        "density": 1500.0,
    }
    weights = rng.standard_normal(base["forces"].shape)
    of.solve(values)
    found = of.pullback(weights)
    step = {"cells.young": 1e3, "cells.strain": 1e-6, "cells.curvature": 1e-3, "forces": 1e-6, "density": 0.1}
    for key, h in step.items():
        way = rng.standard_normal(np.shape(values[key]))
        up, down = (of.solve({**values, key: values[key] + n * h * way}) for n in (1, -1))
        expected = np.sum(weights * (up - down)) / (2.0 * h)
        assert np.sum(found[key] * way) == pytest.approx(expected, rel=1e-6), key


def test_a_field_is_that_of_the_scene_that_has_it():
    """The E of every cell times one factor is the scene's, of some cells a patch's; sums of derivatives."""
    scene = scene_of("one-edge-clamped")
    of = lumped.Differentiable(scene, calibrated(scene, 9))
    unsolved = of.pullback(np.ones(of.base["forces"].shape))["cells.young"]  # at the scene's own values
    stiffer = of.solve({"cells.young": 1.1 * of.base["cells.young"]})
    assert np.allclose(stiffer, of.solve({"young": 1.1 * scene.material.young}), rtol=0, atol=1e-12)
    half = {
        "shape": {"rectangle": {"x": (0.094, 0.188), "y": (0.0, 0.188)}},
        "young": 2.0 * scene.material.young,
    }
    patched = scene.replace(patches=[half])
    same = lumped.Differentiable(patched, calibrated(patched, 9)).solve({})
    of_half = of.base["cells.young"] * np.repeat([1.0, 2.0], 4)
    assert np.allclose(of.solve({"cells.young": of_half}), same, rtol=0, atol=1e-12)
    of.solve({})
    found = of.pullback(np.ones_like(stiffer))
    assert np.allclose(found["cells.young"], unsolved, rtol=1e-9)
    assert found["cells.young"].sum() == pytest.approx(found["young"], rel=1e-9)
    assert found["cells.density"].sum() == pytest.approx(found["density"], rel=1e-9)
    thicker = found["cells.thickness"].sum()  # of layers as far apart as they are
    assert thicker == pytest.approx(found["thickness"], rel=2e-2)


# what the first gradient of a scene makes: both sides of ν and h, of gravity along x, y and z, and of a tilt
COUNTED = {
    "lumped.gradient.build_problem": 12,
    "lumped.parameter_sides.springs_of_sheets": 1,  # all four at once
    "lumped.parameter_sides.calibrated_at_rest": 0,
    "lumped.assembly.build": 0,  # of plans
    "lumped.assembly.springs_of": 4,
    "lumped.statics.build.constrain": 2,
}


def count(monkeypatch, name):
    """The calls of a function from now on."""
    module, _, function = name.rpartition(".")
    original, calls = getattr(import_module(module), function), []
    monkeypatch.setattr(name, lambda *given, **options: calls.append(1) or original(*given, **options))
    return calls


def test_a_second_gradient_of_a_scene_makes_no_lattice_and_no_springs(monkeypatch):
    scene = scene_of("one-edge-clamped")
    springs = calibrated(scene, GRID)
    u = solve_path(build_problem(scene, springs)).state.u
    base = Equilibrium.of(scene, springs, u)
    made = {name: count(monkeypatch, name) for name in COUNTED}
    first = dict(base.pullback(np.ones_like(u)))
    assert len(first) == 15 and {"poisson", "cells.poisson", "tilt_x0"} <= first.keys()
    assert {name: len(calls) for name, calls in made.items()} == COUNTED
    for name in COUNTED:
        monkeypatch.delattr(name)
    again = Equilibrium.of(scene, springs, u).pullback(2.0 * np.ones_like(u))
    for name, value in first.items():
        assert np.allclose(again[name], 2.0 * value, rtol=1e-9, atol=1e-12 * np.abs(value).max()), name


def test_designs_in_turn_have_each_their_own_derivatives(monkeypatch):
    """The rates of springs by all fields are found once a design, and those of another are not taken."""
    of, rng = lumped.Differentiable("one-edge-clamped"), np.random.default_rng(2)
    first, second = (of.base["cells.young"] * rng.uniform(0.8, 1.2, (8, 8)) for _ in range(2))
    made = count(monkeypatch, "lumped.cell_fields.springs_of_cells")
    for young in (first, second, first):
        u = of.solve(values := {"cells.young": young})
        found = of.pullback(weights := np.ones_like(u))
        found = {name: found[name] for name in of.base}
        assert made == [1]
        alone = Equilibrium(Base(of.scene, of.calibration), u, values).pullback(weights)
        for name, value in found.items():
            assert np.allclose(value, alone[name], rtol=1e-9, atol=1e-12 * np.abs(value).max()), name
        made.clear()


def test_an_equilibrium_that_is_none_or_unstable_has_no_derivatives():
    flat = scene_of(
        "one-edge-clamped", gravity=None, loads=(EdgeLoad(edge="x1", force_per_length=(-60.0, 0, 0)),)
    )
    with pytest.raises(NoEquilibrium, match="unstable"):
        lumped.Differentiable(flat).solve({})
    answer = lumped.solve(flat)
    with pytest.raises(NoEquilibrium):
        answer.gradient(of=np.zeros((1, 3)), at=[[0.1, 0.1]])
    of = Equilibrium.of(flat, default(flat), solve_path(build_problem(flat, default(flat))).state.u)
    with pytest.raises(NoEquilibrium, match="an unstable equilibrium"):
        of.pullback(np.ones((162, 3)))


def test_an_answer_has_the_gradient_of_a_component_an_array_and_a_function():
    answer = lumped.solve(scene := scene_of("one-edge-clamped"))
    answer = replace(answer, points=dict(scene.probes))
    weights = np.zeros((4, 3))
    weights[3, 2] = 1.0
    by = ["material.young", "sheet.thickness", "cells.young"]
    each = [answer.gradient(of=of, by=by) for of in ("P4.uz", weights, lambda u: u[3, 2])]
    for found in each[1:]:
        for name in by:
            assert np.allclose(found[name], each[0][name], rtol=1e-9)
    slope = forward(scene, default(scene), ["young"])[1]["young"]
    assert each[0]["material.young"] == pytest.approx(slope[3, 2], rel=1e-12)
    assert {"young", "tilt_x0", "gravity.z", "cells.curvature", "forces"} <= answer.gradient(
        of="P4.uz"
    ).keys()
    for of in ("P9.uz", "P4", np.zeros((2, 3))):
        with pytest.raises(BadInput, match="gradient: of"):
            answer.gradient(of=of)
    with pytest.raises(BadInput, match="no derivatives"):
        lumped.solve(scene, linear=True).gradient(of="P4.uz")
