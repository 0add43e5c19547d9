"""Sheets with a natural strain or curvature, in every model, against closed forms and each other."""

import numpy as np
import pytest

import fem_reference
import lumped
import sheetbench as sb
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from lumped.assembly import Assembly
from lumped.pretension import with_pretension_strain
from lumped.statics.solver import build_problem
from sheetbench.errors import BadInput
from sheetbench.scenes import (
    EDGES,
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
)
from sheetbench.scenes.meaning.natural_state import sheet_at_rest
from sheetbench.scenes.objects.natural import Natural, Temperature

YOUNG, POISSON = 1e6, 0.3
MATERIAL = Material(YOUNG, POISSON, 1e3)
CLAMP = (Clamped("x0"),)


def scene(length_x, length_y, thickness, supports=CLAMP, weight=0.0, **more):
    gravity = Gravity((0.0, 0.0, -weight)) if weight else None
    sheet, probes = Sheet(length_x, length_y, thickness), {"tip": [length_x, length_y / 2]}
    return Scene("natural", sheet, MATERIAL, gravity, tuple(supports), probes=probes, **more)


def springs(of, grid):
    sheet, grid = sheet_at_rest(of), (grid, grid, 2) if isinstance(grid, int) else grid
    return lumped.calibrate(sheet, of.material, grid=grid, cells=lumped.sections_of(of, grid))


def tip(of, model, size, point=None):
    """Where the tip moves, and the answer; size: elements, or masses of the lattice."""
    if model == "lumped":
        found = lumped.solve(of, springs(of, size))
    else:
        found = fem_reference.solve(of, model=model, elements=size)
    assert found.succeeded, found.message
    return found.displacement([point or of.probes["tip"]])[0], found


def held_square(times, kind):
    """Of a square held all around, times the strain e0 = π² h²/6 (1 + ν) a² (Kirchhoff, hinged)."""
    strain = times * np.pi**2 * 0.002**2 / (6.0 * (1.0 + POISSON) * 0.2**2)
    return scene(0.2, 0.2, 0.002, [kind(edge) for edge in EDGES], natural=Natural((strain, strain, 0.0)))


@pytest.mark.parametrize(("model", "size"), [("lumped", (9, 5, 2)), ("plate", 4), ("shell", 4), ("solid", 4)])
def test_a_free_sheet_grows_to_its_natural_size_without_stress(model, size):
    rims = [Symmetric("x0"), Symmetric("y0"), *(Held(e, components=("z",)) for e in ("x1", "y1"))]
    moved, found = tip(scene(0.2, 0.1, 0.004, rims, natural=Natural((0.08, -0.03, 0.0))), model, size)
    np.testing.assert_allclose(moved, [0.016, -0.0015, 0.0], atol=1e-11)
    assert sum(found.energies.values()) < 1e-19
    if model == "lumped":  # strain is that from the natural length
        assert np.abs(found.mesh.cell_data["strain"][0]).max() < 1e-12


def rolled(turns):
    """A cantilever of so many turns, its natural curvature and where its tip is on the arc."""
    k = 2.0 * np.pi * turns / 0.2
    arc = np.array([np.sin(0.2 * k) / k - 0.2, 0.0, (1.0 - np.cos(0.2 * k)) / k])
    return scene(0.2, 0.1, 0.002, natural=Natural(curvature=(k, 0.0, 0.0))), k, arc


@pytest.mark.parametrize(("turns", "coarse"), [(0.25, 1.65e-3), (0.9, 2.25e-2)])
def test_a_lattice_rolls_up_to_its_natural_curvature_without_energy(turns, coarse):
    """Its masses lie on a circle of 1/k0; each cell turns by 2 asin(l k0/2): second order."""
    (of, k, arc), errors = rolled(turns), []
    for n in (9, 17, 33):
        moved, found = tip(of, "lumped", (n, (n + 1) // 2, 2))
        errors.append(np.linalg.norm(moved - arc) / 0.2)
        assert sum(found.energies.values()) < 1e-25
        at = found.mesh.points + found.mesh.point_data["displacement"]
        middle = 0.5 * (at[::2] + at[1::2])
        np.testing.assert_allclose(np.hypot(middle[:, 0], middle[:, 2] - 1.0 / k), 1.0 / k, rtol=1e-9)
    assert errors[0] < coarse
    assert np.all(np.abs(np.log2(np.array(errors[:-1]) / errors[1:]) - 2.0) < 0.1)


@pytest.mark.parametrize(("turns", "within"), [(0.25, 5e-6), (0.9, 1e-4)])
def test_the_shell_rolls_up_without_energy_and_of_fourth_order(turns, within):
    (of, _, arc), errors = rolled(turns), []
    for elements in (4, 8):
        moved, found = tip(of, "shell", elements)
        errors.append(np.linalg.norm(moved - arc) / 0.2)
        assert sum(found.energies.values()) < 1e-24
    assert errors[0] < within and np.log2(errors[0] / errors[1]) > 3.5
    solid = tip(of, "solid", 4)[0]  # which has the strain of every height
    assert np.linalg.norm(solid - arc) / 0.2 < 5.0 * within


def test_all_models_agree_with_published_bricks_where_rotations_are_small():
    """Cantilever of isotropic and of orthotropic expansion: uz of tip and corner [mm] by C3D20R."""
    isotropic, orthotropic = ((0.25, 0.25, 0.0), (5.0997, 5.3762)), ((0.25, 0.1, 0.0), (5.1621, 5.2661))
    for (k, published), models in ((isotropic, ("shell",)), (orthotropic, ("shell", "solid"))):
        for model in models:
            _, found = tip(scene(0.2, 0.1, 0.0005, natural=Natural(curvature=k)), model, 8)
            at = 1e3 * found.displacement([[0.2, 0.05], [0.2, 0.1]])[:, 2]
            np.testing.assert_allclose(at, published, rtol=3e-4)


@pytest.mark.parametrize(
    ("model", "until", "longer"),
    [("lumped", None, 1.1**3), ("lumped", 0.2, 1.1**3), ("lumped", 0.1, 1.1986), ("shell", None, 1.1**3),
     ("solid", None, 1.1**3)],
)  # fmt: skip
def test_the_moduli_of_what_has_grown_are_those_of_its_natural_sides(model, until, longer):
    """A strip 10 % longer bends 1.1³ as far under the same weight; of the sheet as drawn 1.17, 1.207."""
    bent = []
    for strain in (0.0, 0.1):
        own = Natural((strain, 0.0, 0.0))
        part = {"shape": {"rectangle": {"x": (0.0, until or 0.2), "y": (0.0, 0.05)}}, "natural": own}
        of = scene(0.2, 0.05, 0.002, CLAMP, 1e-3, **({"patches": (part,)} if until else {"natural": own}))
        found = lumped.solve(of) if model == "lumped" else fem_reference.solve(of, model, elements=4)
        bent.append(found.displacement([[0.2, 0.025]])[0][2])
    assert bent[1] / bent[0] == pytest.approx(longer, rel=4e-3)


def test_the_lattice_is_within_two_thousandths_of_the_shell_with_a_band_of_muscle_under_weight():
    band = {"rectangle": {"x": (0.05, 0.1), "y": (0.0, 0.1)}}
    patch = Patch(shape=band, natural=Natural(curvature=(20.0, 0.0, 0.0)))
    of = scene(0.2, 0.1, 0.002, CLAMP, 0.981, patches=(patch,))
    shell, solid = (tip(of, model, 8)[0] for model in ("shell", "solid"))
    lattice = lumped.solve(of, lumped.calibrate(of.sheet, of.material, (33, 17, 2))).displacement(
        [[0.2, 0.05]]
    )
    assert np.abs(lattice - shell).max() < 2e-3 * np.abs(shell).max()
    assert np.abs(solid - shell).max() < 3e-4 * np.abs(shell).max()


@pytest.mark.parametrize(
    ("model", "size"),
    [("lumped", (41, 5, 2)), *(pytest.param(m, 3, marks=pytest.mark.nightly) for m in ("shell", "solid"))],
)
def test_a_bimetal_bends_as_timoshenko_says(model, size):
    """Layers of 1 and 2 mm, E 1 : 3, which the solid has itself; 0.3 ν k0 b more at the clamp."""
    layers = (
        Layer(thickness=0.001, young=YOUNG, poisson=POISSON, expansion=1e-4),
        Layer(thickness=0.002, young=3 * YOUNG, poisson=POISSON, expansion=0.0),
    )
    of = scene(0.2, 0.02, 0.003, layers=layers, temperature=Temperature(change=10.0))
    ratio, stiff = 0.5, 1.0 / 3.0
    k = 6.0 * 1e-3 * (1.0 + ratio) ** 2 / 0.003
    k /= 3.0 * (1.0 + ratio) ** 2 + (1.0 + ratio * stiff) * (ratio**2 + 1.0 / (ratio * stiff))
    arc = 0.5 * k * 0.2**2 + 0.3 * POISSON * k * 0.02 * 0.2
    assert tip(of, model, size)[0][2] == pytest.approx(arc, rel=6e-3)


@pytest.mark.parametrize(("kind", "times"), [(Hinged, 1.0), (Clamped, 2.6547)])
def test_a_heated_lattice_buckles_where_kirchhoff_says(kind, times):
    """Whose thickness gives way first: with tangents of the flat lattice it buckles at 0.81 of that."""
    of = held_square(times, kind)
    found = [lumped.buckling(of, springs(of, n)).load_factors[0] for n in (9, 17)]
    assert found[1] == pytest.approx(1.0, rel=0.016) and abs(found[1] - 1.0) < abs(found[0] - 1.0)


@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    ("model", "size", "times", "rise"),
    [
        ("lumped", 17, 2.0, 0.873),
        ("lumped", 17, 5.0, 1.682),
        ("shell", 8, 2.0, 0.864),
        ("shell", 8, 5.0, 1.679),
    ],
)
def test_a_heated_plate_past_buckling_is_not_found_flat(model, size, times, rise):
    """Perfectly flat sheets leave the flat state where they buckle, and say at what share of the heat: up to
    the smallest load step below it, and below the thin plate's by their shear and mesh."""
    of, within = held_square(times, Hinged), 0.012 if model == "lumped" else 2e-3
    moved, found = tip(of, model, size, point=[0.1, 0.1])
    assert abs(moved[2]) / 0.002 == pytest.approx(rise, rel=within)
    (left,), softer = found.snaps, 0.03 if model == "lumped" else 0.01
    assert (1.0 - softer) / times - 2.0**-10 < left < (1.0 + softer) / times
    plate = fem_reference.solve(of, model="plate", elements=8)
    assert not plate.succeeded and "buckle it" in plate.message


def test_frequencies_of_a_stretched_square():
    """ω² = (D q² + N q)/ρh, q = 2π²/a²: where the tension is most of it within 0.1 %, of second order."""
    h, tension, q = 2.5e-4, 0.05, 2.0 * np.pi**2 / 0.04
    natural = Natural(pretension=(tension, tension))
    of = scene(0.2, 0.2, h, [Hinged(edge) for edge in EDGES], natural=natural)
    found = [lumped.modes(of, springs(of, n), 1, about="deformed").frequencies[0] for n in (17, 33)]
    bending = YOUNG * h**3 / (12.0 * (1.0 - POISSON**2))
    exact = np.sqrt((bending * q**2 + tension * q) / (1e3 * h)) / (2.0 * np.pi)
    assert found[1] == pytest.approx(exact, rel=1e-3)
    assert np.log2((found[0] - exact) / (found[1] - exact)) == pytest.approx(2.0, abs=0.1)
    same = springs(of, 9)
    flat, unstretched = (lumped.modes(s, same, 1).frequencies[0] for s in (of, of.replace(natural=None)))
    assert flat == pytest.approx(unstretched, rel=1e-4)  # cells resist strains of their natural sides


CONSTANTS = dict(young_1=3e6, young_2=1.4e6, poisson_12=0.3, shear_12=6e5, shear_13=6e5, shear_23=6e5)
FIBRES = Material(kind="orthotropic", density=1e3, angle=0.5, **CONSTANTS)
TWICE = FactorTable(time=(0.0, 1.0), factor=(0.0, 2.0))


@pytest.mark.sweep
@pytest.mark.parametrize(
    "model", ["lumped:grid=7", "shell:elements=2", "solid:elements=2", "plate:elements=2"]
)
@pytest.mark.parametrize(
    ("share", "material", "history"),
    [
        (0.01, Material(1.4e6, 0.42, 1e3), None),
        (0.1, Material(1.4e6, 0.0, 1e3), None),  # of the lattice 14, of the shell 30 % too much
        (0.1, FIBRES, None),
        (0.05, Material(1.4e6, 0.42, 1e3), TWICE),
    ],
)
def test_held_where_it_is_drawn_a_sheet_pulls_with_its_pretension(model, share, material, history):
    """Whatever law of strain the model has; lattices of fibres at an angle but for their edges' layers."""
    sheet, times = Sheet(0.3, 0.18, 9e-4), history.factor[-1] if history else 1.0
    along_x, along_y = share * 1.4e6 * 9e-4, 0.6 * share * 1.4e6 * 9e-4
    held = [Held(edge, components=("xy"[edge[0] == "y"], "z")) for edge in EDGES]
    own = Natural(pretension=(along_x, along_y), history=history)
    found = sb.solve(Scene("held", sheet, material, supports=held, natural=own), model)
    assert found.succeeded, found.message
    assert found.reactions["x1"][0] == pytest.approx(times * along_x * 0.18, rel=1e-5)
    assert found.reactions["y1"][1] == pytest.approx(times * along_y * 0.3, rel=1e-5)


@pytest.mark.parametrize("cutouts", [(), [{"shape": {"circle": {"centre": (0.15, 0.09), "radius": 0.03}}}]])
def test_a_lattices_pretension_is_not_that_of_its_cut_cells(cutouts):
    """With a hole, and cells that the rim of a clamp cuts, the natural strain is the whole sheet's."""
    clamp = Clamped(where={"rectangle": {"x": (0.0, 0.07), "y": (0.0, 0.18)}})
    own = Natural(pretension=(60.0, 30.0))
    plain = Scene("cut", Sheet(0.3, 0.18, 9e-4), MATERIAL, supports=[clamp], natural=own)
    found = [
        with_pretension_strain(
            of, Assembly(of.sheet, resolve(of, Lattice(grid=(11, 9), grading=0)).springs)
        ).natural.strain
        for of in (plain.replace(supports=CLAMP), plain.replace(cutouts=cutouts))
    ]
    assert found[1] == pytest.approx(found[0], rel=1e-6, abs=1e-9)


def test_the_energy_of_a_share_of_the_natural_state_is_the_work_of_its_forces():
    disc = {"circle": {"centre": (0.1, 0.05), "radius": 0.04}}
    band = Patch(shape=disc, natural=Natural((0.02, 0.01, 0.03), (3.0, -2.0, 4.0)))
    of = scene(0.2, 0.1, 0.002, natural=Natural((0.0, 0.04, 0.0)), patches=(band,))
    problem = build_problem(of, springs(of, (5, 4, 2)))
    u, move = (1e-3 * np.random.default_rng(seed).standard_normal((40, 3)) for seed in (0, 1))
    for share in (0.3, 1.0):
        force = problem.internal(u, share)[1]
        up, down = (problem.internal(u + s * 1e-4 * move, share)[0] for s in (1.0, -1.0))
        assert (up - down) / 2e-4 == pytest.approx(float(np.sum(force * move)), rel=1e-6)
        blocks = problem.system.matrix(problem.tangent(u, share))
        held = np.where(problem.constraints.fixed, 0.0, move)
        ahead, behind = (problem.internal(u + s * 1e-6 * held, share)[1] for s in (1.0, -1.0))
        along, found = problem.reduce((ahead - behind) / 2e-6), blocks @ problem.constraints.nearest(held)
        np.testing.assert_allclose(found, along, rtol=1e-5, atol=1e-6 * np.abs(along).max())


@pytest.fixture(scope="module")
def growing():
    """A cantilever whose natural curvature grows, and its motion on the lattice."""
    ramp = FactorTable(time=(0.0, 0.1), factor=(0.0, 1.0))
    of = scene(0.2, 0.1, 0.002, natural=Natural(curvature=(0.5, 0.0, 0.0), history=ramp))
    return of, lumped.simulate(of, lumped.calibrate(of.sheet, of.material, (13, 7, 2)), 0.2, every=0.02)


@pytest.mark.sweep
@pytest.mark.parametrize("model", ["plate", "shell", "solid"])
def test_a_curvature_that_grows_moves_every_reference_as_it_does_the_lattice(growing, model):
    of, lattice = growing
    found = fem_reference.simulate(of, model, 0.2, elements=2, every=0.02)
    assert found.succeeded
    off = np.abs(found.probes["tip"] - lattice.probes["tip"])[:, 2].max()
    assert off < 0.03 * np.abs(lattice.probes["tip"]).max()
    assert np.abs(found.balance - found.balance[0]).max() < 0.01 * found.energies["work"].max()


def test_what_has_no_natural_shape_is_refused_by_name():
    of = scene(0.2, 0.1, 0.002, CLAMP, 1.0, natural=Natural(curvature=(1.0, 0.0, 0.0)))
    with pytest.raises(BadInput, match="at once"):
        lumped.buckling(of, springs(of, 5))
    for model in ("shell", "solid"):
        with pytest.raises(BadInput, match="law 'neo-hookean' is for sheets that are flat at rest"):
            fem_reference.solve(of, model=model, elements=2, law="neo-hookean")


def test_a_free_dome_snaps_into_a_cylinder_at_the_same_curvature_in_both_models():
    """Uniform curvatures lose stability at k0 = 2 κc/(1 + ν), κc = h/(a² √(12 (1 + ν) c)), c = 3.891e-4 of a
    square (of a disc 8 h/R² (1 + ν)^1.5); the square itself, whose rims curl, at 0.97 of that. A quarter."""
    a, h = 0.2, 0.002
    limit = 2.0 * h / (a**2 * np.sqrt(12.0 * 1.3 * 3.891e-4)) / 1.3
    rims = [Symmetric("x0"), Symmetric("y0"), Point(at=(0.0, 0.0), components=("z",))]
    of = scene(0.1, 0.1, h, rims, natural=Natural(curvature=(1.5 * limit, 1.5 * limit, 0.0)))
    shell = tip(of, "shell", 4)[1]
    lattice = lumped.solve(of, lumped.calibrate(of.sheet, of.material, (9, 9, 2)))
    assert lattice.succeeded and shell.snaps == pytest.approx([0.971 / 1.5], rel=5e-3)
    assert lattice.snaps == pytest.approx(shell.snaps, rel=0.02)
    for found, rel in ((shell, 0.02), (lattice, 0.1)):
        rise = np.sort(np.abs(found.displacement([[0.1, 0.0], [0.0, 0.1]])[:, 2])) / h
        assert rise[1] == pytest.approx(3.78, rel=rel) and rise[0] == pytest.approx(0.45, abs=0.06)
