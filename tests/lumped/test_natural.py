"""Sheets with a natural strain or curvature on the lattice, against closed forms (`lumped.natural`)."""

import numpy as np
import pytest

import lumped
from lumped.statics.solver import build_problem
from sheetbench.errors import BadInput
from sheetbench.scenes import Clamped, Gravity, Held, Hinged, Layer, Material, Patch, Scene, Sheet, Symmetric
from sheetbench.scenes.meaning.natural_state import sheet_at_rest
from sheetbench.scenes.objects.natural import Natural, Temperature

EDGES = ("x0", "x1", "y0", "y1")
YOUNG, POISSON = 1e6, 0.3
BENDING = YOUNG / (12.0 * (1.0 - POISSON**2))  # D over h³


def scene(length_x, length_y, thickness, supports, weight=0.0, **more):
    return Scene(
        name="natural",
        sheet=Sheet(length_x=length_x, length_y=length_y, thickness=thickness),
        material=Material(young=YOUNG, poisson=POISSON, density=1e3),
        supports=tuple(supports),
        gravity=Gravity(acceleration=(0.0, 0.0, -weight)) if weight else None,
        probes={"tip": [length_x, length_y / 2]},
        **more,
    )


def springs(of, grid):
    sheet, grid = sheet_at_rest(of), (grid, grid, 2) if isinstance(grid, int) else grid
    return lumped.calibrate(sheet, of.material, grid=grid, cells=lumped.sections_of(of, grid))


def tip(of, grid):
    found = lumped.solve(of, springs(of, grid))
    assert found.succeeded, found.message
    return found.displacement([of.probes["tip"]])[0], found


def held_square(thickness, kind, strain):
    return scene(0.2, 0.2, thickness, [kind(edge=e) for e in EDGES], natural=Natural((strain, strain, 0.0)))


def hinged_buckling_strain(thickness):
    """Of a square with all sides hinged, e0 = π² h²/6 (1 + ν) a² (Kirchhoff)."""
    return np.pi**2 * thickness**2 / (6.0 * (1.0 + POISSON) * 0.2**2)


def test_a_free_sheet_grows_to_its_natural_size_without_stress():
    rims = [Symmetric(edge="x0"), Symmetric(edge="y0")]
    rims += [Held(edge=e, components=("z",)) for e in ("x1", "y1")]
    moved, found = tip(scene(0.2, 0.1, 0.004, rims, natural=Natural((0.08, -0.03, 0.0))), (9, 5, 2))
    np.testing.assert_allclose(moved, [0.016, -0.0015, 0.0], atol=1e-14)
    assert sum(found.energies.values()) < 1e-24
    lengths = found.mesh.cell_data["strain"][0]
    assert np.abs(lengths).max() < 1e-12  # strain is that from the natural length


@pytest.mark.parametrize(("turns", "coarse"), [(0.25, 1.65e-3), (0.9, 2.25e-2)])
def test_a_cantilever_rolls_up_to_its_natural_curvature_without_energy(turns, coarse):
    """Its masses lie on a circle of 1/k0; each cell turns by 2 asin(l k0/2): second order."""
    k = 2.0 * np.pi * turns / 0.2
    arc = np.array([np.sin(0.2 * k) / k - 0.2, 0.0, (1.0 - np.cos(0.2 * k)) / k])
    errors = []
    for n in (9, 17, 33):
        moved, found = tip(
            scene(0.2, 0.1, 0.002, [Clamped(edge="x0")], natural=Natural(curvature=(k, 0.0, 0.0))),
            (n, (n + 1) // 2, 2),
        )
        errors.append(np.linalg.norm(moved - arc) / 0.2)
        assert sum(found.energies.values()) < 1e-25
        at = found.mesh.points + found.mesh.point_data["displacement"]
        middle = 0.5 * (at[::2] + at[1::2])
        radii = np.hypot(middle[:, 0], middle[:, 2] - 1.0 / k)
        np.testing.assert_allclose(radii, 1.0 / k, rtol=1e-9)
    assert errors[0] < coarse
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(np.abs(orders - 2.0) < 0.1)


def test_a_band_of_muscle_lifts_a_cantilever_against_its_weight():
    """Second order, its borders inside cells too; 0.3 % at 17 across of what 33 and the order foretell."""
    for x in ((0.05, 0.1), (0.06, 0.11)):
        band = Patch(
            shape={"rectangle": {"x": x, "y": (0.0, 0.1)}}, natural=Natural(curvature=(20.0, 0.0, 0.0))
        )
        of = scene(0.2, 0.1, 0.002, [Clamped(edge="x0")], 0.981, patches=(band,))
        found = [tip(of, (2 * n - 1, n, 2))[0] for n in (5, 9, 17, 33)]
        exact = found[3] + (found[3] - found[2]) / 3.0
        off = [np.linalg.norm(u - exact) / np.linalg.norm(exact) for u in found]
        assert off[2] < 3e-3
        assert np.log2(off[0] / off[2]) / 2.0 > 1.8


def test_a_clamped_strip_of_isotropic_curvature_turns_a_little_more_than_an_arc():
    """By 0.3 ν k0 b at the clamp, which keeps its width flat."""
    k, b = 0.5 * np.pi / 0.2, 0.01
    of = scene(0.2, b, 0.002, [Clamped(edge="x0")], natural=Natural(curvature=(k, k, 0.0)))
    more = 0.3 * POISSON * k * b
    arc = (1.0 - np.cos(0.2 * k)) / k + more * np.sin(0.2 * k) / k
    assert tip(of, (81, 5, 2))[0][2] == pytest.approx(arc, rel=2e-3)


@pytest.mark.parametrize(("until", "longer"), [(None, 1.1**3), (0.2, 1.1**3), (0.1, 1.1986)])
def test_the_moduli_of_what_has_grown_are_those_of_its_natural_sides(until, longer):
    """A strip 10 % longer bends under the same weight by 1.1³ as far, grown by itself or by a patch; a
    calibration of the sheet as drawn gives 1.17, 1.207. A patch on half of it: as the shell (`fem_reference`
    on three elements across)."""
    bent = []
    for strain in (0.0, 0.1):
        own = Natural((strain, 0.0, 0.0))
        patches = (
            ()
            if until is None
            else ({"shape": {"rectangle": {"x": (0.0, until), "y": (0.0, 0.05)}}, "natural": own},)
        )
        of = scene(
            0.2, 0.05, 0.002, [Clamped(edge="x0")], 1e-3, natural=None if patches else own, patches=patches
        )
        bent.append(lumped.solve(of).displacement([[0.2, 0.025]])[0][2])
    assert bent[1] / bent[0] == pytest.approx(longer, rel=4e-3)


def test_a_bimetal_bends_as_timoshenko_says():
    """Layers of 1 and 2 mm, E 1 : 3; 0.3 ν k0 b more at the clamp."""
    layers = (
        Layer(thickness=0.001, young=YOUNG, poisson=POISSON, expansion=1e-4),
        Layer(thickness=0.002, young=3 * YOUNG, poisson=POISSON, expansion=0.0),
    )
    of = scene(0.2, 0.02, 0.003, [Clamped(edge="x0")], layers=layers, temperature=Temperature(change=10.0))
    ratio, stiff = 0.5, 1.0 / 3.0
    k = 6.0 * 1e-3 * (1.0 + ratio) ** 2 / 0.003
    k /= 3.0 * (1.0 + ratio) ** 2 + (1.0 + ratio * stiff) * (ratio**2 + 1.0 / (ratio * stiff))
    arc = 0.5 * k * 0.2**2 + 0.3 * POISSON * k * 0.02 * 0.2
    assert tip(of, (41, 5, 2))[0][2] == pytest.approx(arc, rel=6e-3)


@pytest.mark.parametrize(("kind", "times"), [(Hinged, 1.0), (Clamped, 2.6547)])
def test_a_heated_plate_buckles_where_kirchhoff_says(kind, times):
    """Whose thickness gives way first: with tangents of the flat lattice it buckles at 0.81 of that. Clamped:
    5.304 π² D/a² of both ways."""
    of = held_square(0.002, kind, times * hinged_buckling_strain(0.002))
    found = [lumped.buckling(of, springs(of, n)).load_factors[0] for n in (9, 17)]
    assert found[1] == pytest.approx(1.0, rel=0.016) and abs(found[1] - 1.0) < abs(found[0] - 1.0)


@pytest.mark.sweep(2)
@pytest.mark.parametrize(("kind", "times", "rise"), [(Hinged, 2.0, 0.873), (Hinged, 5.0, 1.682)])
def test_a_heated_plate_past_buckling_is_not_found_flat(kind, times, rise):
    """Perfectly flat sheets leave the flat state where they buckle, and say at what share of the heat."""
    of = held_square(0.002, kind, times * hinged_buckling_strain(0.002))
    found = lumped.solve(of, springs(of, 17))
    assert found.succeeded
    assert abs(found.displacement([[0.1, 0.1]])[0][2]) / 0.002 == pytest.approx(rise, rel=0.012)
    assert found.snaps == pytest.approx([1.0 / times], rel=0.03)


def test_frequencies_of_a_stretched_square():
    """ω² = (D q² + N q)/ρh, q = 2π²/a²: where the tension is most of it within 0.1 %, of second order."""
    h, tension, q = 2.5e-4, 0.05, 2.0 * np.pi**2 / 0.04
    of = scene(0.2, 0.2, h, [Hinged(edge=e) for e in EDGES], natural=Natural(pretension=(tension, tension)))
    found = [lumped.modes(of, springs(of, n), 1, about="deformed").frequencies[0] for n in (17, 33)]
    exact = np.sqrt((BENDING * h**3 * q**2 + tension * q) / (1e3 * h)) / (2.0 * np.pi)
    assert found[1] == pytest.approx(exact, rel=1e-3)
    assert np.log2((found[0] - exact) / (found[1] - exact)) == pytest.approx(2.0, abs=0.1)
    same = springs(of, 9)
    flat = lumped.modes(of, same, 1).frequencies[0]
    unstretched = lumped.modes(of.replace(natural=None), same, 1).frequencies[0]
    assert flat == pytest.approx(unstretched, rel=1e-4)  # cells resist strains of their natural sides


def test_held_flat_a_sheet_pulls_at_its_supports_with_its_pretension():
    of = scene(0.2, 0.1, 0.002, [Hinged(edge=e) for e in EDGES], natural=Natural(pretension=(2.0, -0.5)))
    found = lumped.solve(of, springs(of, (9, 5, 2)))
    assert found.reactions["x1"][0] + found.reactions["x0"][0] == pytest.approx(0.0, abs=1e-12)
    small = lumped.solve(of, springs(of, (9, 5, 2)), linear=True)
    assert small.reactions["x1"] == pytest.approx(found.reactions["x1"], rel=2e-3, abs=1e-9)
    inside = found.mesh.cell_data["tension"][0]
    assert inside.max() > 0.0


def test_the_energy_of_a_share_of_the_natural_state_is_the_work_of_its_forces():
    """Forces are the gradient at any share; rest data are set in place."""
    band = Patch(
        shape={"circle": {"centre": (0.1, 0.05), "radius": 0.04}},
        natural=Natural((0.02, 0.01, 0.03), (3.0, -2.0, 4.0)),
    )
    of = scene(0.2, 0.1, 0.002, [Clamped(edge="x0")], natural=Natural((0.0, 0.04, 0.0)), patches=(band,))
    problem = build_problem(of, springs(of, (5, 4, 2)))
    random = np.random.default_rng(0)
    u, move = (1e-3 * random.standard_normal((40, 3)) for _ in range(2))
    for share in (0.3, 1.0):
        force = problem.internal(u, share)[1]
        up, down = (problem.internal(u + s * 1e-4 * move, share)[0] for s in (1.0, -1.0))
        assert (up - down) / 2e-4 == pytest.approx(float(np.sum(force * move)), rel=1e-6)
        blocks = problem.system.matrix(problem.tangent(u, share))
        fixed = problem.constraints.fixed
        held = np.where(fixed, 0.0, move)
        ahead, behind = (problem.internal(u + s * 1e-6 * held, share)[1] for s in (1.0, -1.0))
        along = problem.reduce((ahead - behind) / 2e-6)
        np.testing.assert_allclose(
            blocks @ problem.constraints.nearest(held), along, rtol=1e-5, atol=1e-6 * np.abs(along).max()
        )


def test_what_has_no_natural_length_is_refused_by_name():
    of = scene(0.2, 0.1, 0.002, [Clamped(edge="x0")], 1.0, natural=Natural(curvature=(1.0, 0.0, 0.0)))
    with pytest.raises(BadInput, match="precision"):
        lumped.solve(of, springs(of, 5), precision="single")
    with pytest.raises(BadInput, match="at once"):
        lumped.buckling(of, springs(of, 5))
