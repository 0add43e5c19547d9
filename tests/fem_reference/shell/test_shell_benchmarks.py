"""Large rotations and thin sheets against published and closed-form values (see `analytical_shell`)."""

import dataclasses

import numpy as np
import pytest
from analytical_shell import CLAMPED_PLATE, END_SHEAR, HEAVY_ELASTICA, SLIT_ANNULUS, rolled_up
from skfem import MeshQuad, MeshQuad2

import fem_reference
from fem_reference.shell.statics import solve_on
from sheetbench.scenes import Clamped, EdgeLoad, Gravity, Material, Scene, Sheet, Status


def strip(length, width=1.0, thickness=0.1, young=1.2e6, **asked) -> Scene:
    """A strip clamped at x = 0, ν = 0."""
    return Scene(
        name="strip",
        sheet=Sheet(length_x=length, length_y=width, thickness=thickness),
        material=Material(young=young, poisson=0.0, density=1000.0),
        supports=(Clamped(edge="x0"),),
        **asked,
    )


def tip(scene, elements):
    solution = fem_reference.solve(scene, model="shell", elements=elements)
    assert solution.status is Status.CONVERGED
    return solution.displacement([[scene.sheet.length_x, scene.sheet.length_y / 2]])[0]


@pytest.mark.parametrize("share", END_SHEAR)
def test_cantilever_under_end_shear(share):
    displacement = tip(
        strip(10.0, loads=(EdgeLoad(edge="x1", force_per_length=(0, 0, 4.0 * share)),)), (16, 1)
    )
    np.testing.assert_allclose([-displacement[0], displacement[2]], END_SHEAR[share], rtol=5e-3)


@pytest.mark.parametrize("share", [0.25, 0.5, 1.0])
def test_cantilever_rolls_up_to_a_full_circle(share):
    moment = share * 50 * np.pi / 3
    displacement = tip(strip(12.0, loads=(EdgeLoad(edge="x1", moment_per_length=moment),)), (16, 1))
    exact = rolled_up(12.0, 1.2e6 * 0.1**3 / 12, moment)
    np.testing.assert_allclose(displacement[[0, 2]], exact, atol=2e-3 * 12.0)


@pytest.mark.parametrize("load", HEAVY_ELASTICA)
def test_heavy_elastica(load):
    gravity = Gravity(acceleration=(0, 0, -load * 1e7 * 0.01**2 / 12 / 1000.0))
    displacement = tip(strip(1.0, 0.1, 0.01, 1e7, gravity=gravity), (16, 1))
    w, u = HEAVY_ELASTICA[load]
    assert -displacement[2] == pytest.approx(w, rel=2e-3)
    assert -displacement[0] == pytest.approx(u, rel=2e-3)


def test_fourth_order_where_nothing_is_singular():
    """The heavy strip, ν = 0: the tip converges like the fourth power of the element."""
    scene = strip(1.0, 0.1, 0.01, 1e7, gravity=Gravity(acceleration=(0, 0, -5 * 1e7 * 0.01**2 / 12 / 1000.0)))
    fine = tip(scene, (64, 1))
    errors = [np.abs(tip(scene, (n, 1)) - fine).max() for n in (4, 8, 16)]
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert slopes[-1] == pytest.approx(4.0, abs=0.15), (errors, slopes)
    assert errors[-1] < 1e-5


def annulus(radial, around) -> MeshQuad2:
    """Radii 6 to 10 slit along θ = 0, its two sides named y0 (θ = 0) and y1 (θ = 2π)."""
    polar = MeshQuad.init_tensor(np.linspace(6, 10, radial + 1), np.linspace(0, 2 * np.pi, around + 1))
    sides = {"y0": lambda x: np.isclose(x[1], 0), "y1": lambda x: np.isclose(x[1], 2 * np.pi)}
    mesh = MeshQuad2.from_mesh(polar)
    r, theta = mesh.doflocs
    bent = dataclasses.replace(mesh, doflocs=np.array([r * np.cos(theta), r * np.sin(theta)]))
    return bent.with_boundaries({name: polar.facets_satisfying(test) for name, test in sides.items()})


@pytest.mark.parametrize("share", [0.25, 1.0])
def test_slit_annular_plate(share):
    scene = Scene(
        name="slit",
        sheet=Sheet(length_x=20, length_y=20, thickness=0.03),
        material=Material(young=21e6, poisson=0.0, density=1.0),
        supports=(Clamped(edge="y1"),),
        loads=(EdgeLoad(edge="y0", force_per_length=(0, 0, 0.8 * share)),),
    )
    mesh = annulus(6, 48)
    solution = solve_on(mesh, scene)
    assert solution.status is Status.CONVERGED
    lifted = np.unique(mesh.facets[:, mesh.boundaries["y0"]])
    radius = np.hypot(*mesh.p[:, lifted])
    rise = solution.mesh.point_data["displacement"][lifted, 2]
    np.testing.assert_allclose(
        [rise[np.argmin(radius)], rise[np.argmax(radius)]], SLIT_ANNULUS[share], rtol=5e-3
    )


@pytest.mark.parametrize("slenderness", CLAMPED_PLATE)
def test_clamped_plate_does_not_lock(slenderness):
    """Small displacement of a square plate, h/a from 1e-5 to 0.2, on 8 × 8 uniform elements."""
    side, density, young = 1.0, 1000.0, 1e7
    rigidity = young * slenderness**3 / 12 / (1 - 0.3**2)
    centre = 1e-4 * slenderness  # far below the thickness: linear
    load = centre * rigidity / CLAMPED_PLATE[slenderness]
    scene = Scene(
        name="plate",
        sheet=Sheet(length_x=side, length_y=side, thickness=slenderness),
        material=Material(young=young, poisson=0.3, density=density),
        gravity=Gravity(acceleration=(0, 0, -load / (density * slenderness))),
        supports=tuple(Clamped(edge=edge) for edge in ("x0", "x1", "y0", "y1")),
    )
    solution = fem_reference.solve(scene, model="shell", elements=8, graded=False)
    assert solution.status is Status.CONVERGED
    assert -solution.displacement([[0.5, 0.5]])[0, 2] == pytest.approx(centre, rel=3e-3)
