"""Sheets that are not flat at rest in plate, shell and solid, against closed forms and the lattice."""

import numpy as np
import pytest

import fem_reference
import lumped
from sheetbench.errors import BadInput
from sheetbench.scenes import (
    Clamped,
    FactorTable,
    Gravity,
    Held,
    Hinged,
    Layer,
    Material,
    Patch,
    Point,
    Scene,
    Sheet,
    Symmetric,
    load,
)  # fmt: skip
from sheetbench.scenes.objects.natural import Natural, Temperature

EDGES = ("x0", "x1", "y0", "y1")
MATERIAL = Material(young=1e6, poisson=0.3, density=1e3)


def scene(length_x, length_y, thickness, supports, weight=0.0, **more):
    return Scene(
        name="natural", sheet=Sheet(length_x=length_x, length_y=length_y, thickness=thickness),
        material=more.pop("material", MATERIAL), supports=tuple(supports),
        gravity=Gravity(acceleration=(0.0, 0.0, -weight)) if weight else None,
        probes={"tip": [length_x, length_y / 2]}, **more,
    )  # fmt: skip


def tip(of, model, elements=4, point=None):
    found = fem_reference.solve(of, model=model, elements=elements)
    assert found.succeeded, found.message
    return found.displacement([point or of.probes["tip"]])[0], found


@pytest.mark.parametrize("model", ["plate", "shell", "solid"])
def test_a_free_sheet_grows_to_its_natural_size_without_stress(model):
    rims = [Symmetric(edge="x0"), Symmetric(edge="y0")]
    rims += [Held(edge=e, components=("z",)) for e in ("x1", "y1")]
    moved, found = tip(scene(0.2, 0.1, 0.004, rims, natural=Natural((0.08, -0.03, 0.0))), model)
    np.testing.assert_allclose(moved, [0.016, -0.0015, 0.0], atol=1e-11)
    assert sum(found.energies.values()) < 1e-19


@pytest.mark.parametrize(("turns", "within"), [(0.25, 5e-6), (0.9, 1e-4)])
def test_the_shell_rolls_up_without_energy_and_of_fourth_order(turns, within):
    k = 2.0 * np.pi * turns / 0.2
    arc = np.array([np.sin(0.2 * k) / k - 0.2, 0.0, (1.0 - np.cos(0.2 * k)) / k])
    of = scene(0.2, 0.1, 0.002, [Clamped(edge="x0")], natural=Natural(curvature=(k, 0.0, 0.0)))
    errors = []
    for elements in (4, 8):
        moved, found = tip(of, "shell", elements)
        errors.append(np.linalg.norm(moved - arc) / 0.2)
        assert sum(found.energies.values()) < 1e-24
    assert errors[0] < within and np.log2(errors[0] / errors[1]) > 3.5
    solid = tip(of, "solid")[0]  # which has the strain of every height
    assert np.linalg.norm(solid - arc) / 0.2 < 5.0 * within


def test_all_models_agree_with_published_bricks_where_rotations_are_small():
    """Cantilever of isotropic and of orthotropic expansion: uz of tip and corner [mm] by C3D20R."""
    isotropic, orthotropic = ((0.25, 0.25, 0.0), (5.0997, 5.3762)), ((0.25, 0.1, 0.0), (5.1621, 5.2661))
    for (k, published), models in ((isotropic, ("shell",)), (orthotropic, ("shell", "solid"))):
        of = scene(0.2, 0.1, 0.0005, [Clamped(edge="x0")], natural=Natural(curvature=k))
        for model in models:
            _, found = tip(of, model, 8)
            at = 1e3 * found.displacement([[0.2, 0.05], [0.2, 0.1]])[:, 2]
            np.testing.assert_allclose(at, published, rtol=3e-4)


@pytest.mark.parametrize("model", ["shell", "solid"])
def test_the_moduli_of_what_has_grown_are_those_of_its_natural_sides(model):
    bent = []
    for strain in (0.0, 0.1):
        natural = Natural((strain, 0.0, 0.0))
        bent.append(tip(scene(0.2, 0.05, 0.002, [Clamped(edge="x0")], 1e-3, natural=natural), model)[0][2])
    assert bent[1] / bent[0] == pytest.approx(1.1**3, rel=3e-3)


def test_the_lattice_is_within_two_thousandths_of_the_shell_with_a_band_of_muscle_under_weight():
    band = {"rectangle": {"x": (0.05, 0.1), "y": (0.0, 0.1)}}
    patch = Patch(shape=band, natural=Natural(curvature=(20.0, 0.0, 0.0)))
    of = scene(0.2, 0.1, 0.002, [Clamped(edge="x0")], 0.981, patches=(patch,))
    shell, solid = (tip(of, model, 8)[0] for model in ("shell", "solid"))
    lattice = lumped.solve(of, lumped.calibrate(of.sheet, of.material, (33, 17, 2))).displacement(
        [[0.2, 0.05]]
    )
    assert np.abs(lattice[0] - shell).max() < 2e-3 * np.abs(shell).max()
    assert np.abs(solid - shell).max() < 3e-4 * np.abs(shell).max()


@pytest.mark.nightly  # by day: the lattice in lumped/test_natural.py, `self-bending`
def test_a_bimetal_bends_alike_in_all_models():
    """The solid has its layers; z of a strip 20 mm wide, by Timoshenko's k0 [1/m] and 0.3 ν k0 b at the
    clamp."""
    layers = (
        Layer(thickness=0.001, young=1e6, poisson=0.3, expansion=1e-4),
        Layer(thickness=0.002, young=3e6, poisson=0.3, expansion=0.0),
    )
    of = scene(0.2, 0.02, 0.003, [Clamped(edge="x0")], layers=layers, temperature=Temperature(change=10.0))
    shell, solid = (1e3 * tip(of, model, 3)[0][2] for model in ("shell", "solid"))
    assert shell == pytest.approx(solid, rel=2e-3)
    k = 0.320474778
    assert shell == pytest.approx(1e3 * (0.5 * k * 0.2**2 + 0.3 * 0.3 * k * 0.02 * 0.2), rel=5e-3)


def heated(times, kind=Hinged):
    strain = times * np.pi**2 * 0.002**2 / (6.0 * 1.3 * 0.2**2)
    return scene(0.2, 0.2, 0.002, [kind(edge=e) for e in EDGES], natural=Natural((strain, strain, 0.0)))


@pytest.mark.parametrize("model", ["shell", "solid"])
def test_a_heated_plate_buckles_where_kirchhoff_says(model):
    assert fem_reference.buckling(heated(1.0), model, 8).load_factors[0] == pytest.approx(1.0, rel=0.01)


@pytest.mark.sweep(2)
@pytest.mark.parametrize(("times", "rise"), [(2.0, 0.864), (5.0, 1.679)])
def test_a_heated_shell_past_buckling_is_not_found_flat(times, rise):
    moved, found = tip(heated(times), "shell", 8, point=[0.1, 0.1])
    assert abs(moved[2]) / 0.002 == pytest.approx(rise, rel=2e-3)
    assert found.snaps == pytest.approx([1.0 / times], rel=0.012)
    plate = fem_reference.solve(heated(times), model="plate", elements=8)
    assert not plate.succeeded and "buckle it" in plate.message


def test_frequencies_of_a_stretched_square():
    h, tension, q = 2.5e-4, 0.05, 2.0 * np.pi**2 / 0.04
    rigidity = 1e6 * h**3 / 10.92
    natural = Natural(pretension=(tension, tension))
    of = scene(0.2, 0.2, h, [Hinged(edge=e) for e in EDGES], natural=natural)
    found = fem_reference.modes(of, "shell", 8, 1, about="deformed").frequencies[0]
    exact = np.sqrt((rigidity * q**2 + tension * q) / (1e3 * h)) / (2.0 * np.pi)
    assert found == pytest.approx(exact, rel=1e-3)


@pytest.fixture(scope="module")
def growing():
    """A cantilever whose natural curvature grows, and its motion on the lattice."""
    ramp = FactorTable(time=(0.0, 0.1), factor=(0.0, 1.0))
    natural = Natural(curvature=(0.5, 0.0, 0.0), history=ramp)
    of = scene(0.2, 0.1, 0.002, [Clamped(edge="x0")], natural=natural)
    return of, lumped.simulate(of, lumped.calibrate(of.sheet, of.material, (13, 7, 2)), 0.2, every=0.02)


@pytest.mark.sweep
@pytest.mark.parametrize("model", ["solid", "plate", "shell"])
def test_a_curvature_that_grows_moves_every_reference_as_it_does_the_lattice(growing, model):
    of, lattice = growing
    found = fem_reference.simulate(of, model, 0.2, elements=2, every=0.02)
    assert found.succeeded
    off = np.abs(found.probes["tip"] - lattice.probes["tip"])[:, 2].max()
    assert off < 0.03 * np.abs(lattice.probes["tip"]).max()
    assert np.abs(found.balance - found.balance[0]).max() < 0.01 * found.energies["work"].max()


def test_other_laws_of_strain_are_refused_by_name():
    of = scene(0.2, 0.1, 0.002, [Clamped(edge="x0")], natural=Natural(curvature=(5.0, 0.0, 0.0)))
    for model in ("shell", "solid"):
        with pytest.raises(BadInput, match="law 'neo-hookean' is for sheets that are flat at rest"):
            fem_reference.solve(of, model=model, elements=2, law="neo-hookean")


def test_a_free_dome_snaps_into_a_cylinder_at_the_same_curvature_in_both_models():
    """Uniform curvatures lose stability at k0 = 2 κc/(1 + ν), κc = h/(a² √(12 (1 + ν) c)), c = 3.891e-4 of a
    square (of a disc 8 h/R² (1 + ν)^1.5); the square itself, whose rims curl, at 0.97 of that. A quarter."""
    a, h = 0.2, 0.002
    limit = 2.0 * h / (a**2 * np.sqrt(12.0 * 1.3 * 3.891e-4)) / 1.3
    rims = [Symmetric(edge="x0"), Symmetric(edge="y0"), Point(at=(0.0, 0.0), components=("z",))]
    of = scene(0.1, 0.1, h, rims, natural=Natural(curvature=(1.5 * limit, 1.5 * limit, 0.0)))
    shell = tip(of, "shell", 4)[1]
    lattice = lumped.solve(of, lumped.calibrate(of.sheet, of.material, (9, 9, 2)))
    assert lattice.succeeded and shell.snaps == pytest.approx([0.971 / 1.5], rel=5e-3)
    assert lattice.snaps == pytest.approx(shell.snaps, rel=0.02)
    for found, rel in ((shell, 0.02), (lattice, 0.1)):
        rise = np.sort(np.abs(found.displacement([[0.1, 0.0], [0.0, 0.1]])[:, 2])) / h
        assert rise[1] == pytest.approx(3.78, rel=rel) and rise[0] == pytest.approx(0.45, abs=0.06)


@pytest.mark.nightly
def test_a_bistable_bilayer_is_snapped_by_the_same_force_in_both_models():
    """An arch on its corners, pushed down in its middle step by step, each answer from the last one's shape,
    up to the force at which it has no shape beside that any more. The lattice is of second order: from 9
    masses, 3 % above, to 17. Forces within 0.2 %."""
    of, middle = load("bistable-bilayer"), np.array([[0.05, 0.05]])
    springs = lumped.calibrate(of.sheet, of.material, (17, 17, 2), cells=lumped.sections_of(of, (17, 17, 2)))

    def by_lattice(pushed, near):
        found = lumped.solve(pushed, springs, near=near)
        return found, found.mesh.point_data["displacement"]

    def by_shell(pushed, near):
        found = fem_reference.solve(pushed, "shell", elements=8, near=near)
        return found, lambda points: found.displacement(points[:, :2])

    def path(solve):
        force, step, near, rises = 0.0, 0.2, None, {}
        while step > 1.5e-3:
            push = of.loads[0].replace(force=(0.0, 0.0, -force - step * bool(rises)), history=None)
            found, shape = solve(of.replace(loads=(push,)), near)
            assert found.succeeded, found.message
            if (rise := found.displacement(middle)[0, 2]) > 0.0:
                force, near = force + step * bool(rises), shape
                rises[round(force, 6)] = rise
            else:  # upside down
                step /= 2.0
        return force, rises

    (lattice, on_lattice), (shell, on_shell) = path(by_lattice), path(by_shell)
    assert lattice == pytest.approx(shell, rel=0.01) and shell == pytest.approx(0.777, rel=5e-3)
    for force in (0.0, 0.2, 0.4, 0.6):
        assert on_lattice[force] == pytest.approx(on_shell[force], rel=0.01)
