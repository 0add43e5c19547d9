"""Calibrations: closed form against homogenisation, numerical and by imposed strains; the moduli reports."""

import numpy as np
import pytest

import lumped
from lumped import moduli
from lumped.assembly import Assembly
from lumped.calibration.cell_by_cell import each_cell
from lumped.calibration.report import report
from lumped.spring_constants import Springs
from sheetbench import scenes
from sheetbench.scenes import BadInput, PerDirection, SpringSet

pytestmark = pytest.mark.smoke

SEED = scenes.load("two-edges-clamped")
RIGIDITY = 54.5e6 * 0.003**3 / 12 / (1 - 0.48**2)


def imposed_energy(assembly, strain, curvature, shear):
    """Energy per area [J/m²] of the lattice under a uniform plate strain state, thickness relaxed.

    u = ε x − z κ-rotation field: in-plane ε + z κ with γ_xy engineering, transverse shear γ, and the layer
    gap free; every mass is placed, the vertical displacement of the outer layers is minimised over.
    """
    x, y, z = assembly.lattice.positions.T
    e = np.array([[strain[0], strain[2] / 2], [strain[2] / 2, strain[1]]])
    k = np.array([[curvature[0], curvature[2] / 2], [curvature[2] / 2, curvature[1]]])
    plan = np.stack([x, y])
    u = np.zeros((len(x), 3))
    u[:, :2] = (e @ plan).T + z[:, None] * ((k @ plan).T + np.array(shear))
    u[:, 2] = -0.5 * np.einsum("ip,ij,jp->p", plan, k, plan)
    stretch = np.zeros_like(u)
    stretch[:, 2] = z

    # quadratic in the stretch: exact minimum from three values
    h, scale = 1e-9, 1e-6
    a, b, c = (assembly.force(scale * u + s * stretch)[0] for s in (-h, 0.0, h))
    best = 0.5 * h * (a - c) / (a - 2 * b + c) if a - 2 * b + c > 0 else 0.0
    return assembly.force(scale * u + best * stretch)[0] / scale**2 / 0.188**2


@pytest.mark.parametrize("method", ["consistent", "consistent-membrane"])
def test_consistent_is_the_printed_closed_form(method):
    calibration = lumped.calibrate(SEED.sheet, SEED.material, (9, 9), method)
    nu, spacing, share = 0.48, 0.188 / 8, 1 / 3
    shear = 1 / (1 / (5 / 6 * 54.5e6 / 2 / 1.48 * 0.003) + spacing**2 / (12 * RIGIDITY))
    stretching = 12 * RIGIDITY / 0.003**2
    lz2 = (4 * RIGIDITY + 2 * share * shear * spacing**2 / (1 - nu)) / stretching
    if method == "consistent-membrane":
        lz2 = 0.003**2 * (1 - nu + shear * spacing**2 / (6 * RIGIDITY)) / (1 - nu**2)
    c, t = 2 * RIGIDITY / lz2, shear * spacing**2 / (2 * lz2)
    springs = calibration.springs
    assert calibration.layer_distance == pytest.approx(np.sqrt(lz2), rel=1e-12)
    assert springs.axial == pytest.approx(c * (1 - nu), rel=1e-12)
    assert springs.diagonal == pytest.approx(c * (1 - nu) / 2, rel=1e-12)
    assert springs.area == pytest.approx(c * (3 * nu - 1) / 2, rel=1e-12)
    assert springs.cross == pytest.approx(t * (1 - share) * (spacing**2 + lz2) / spacing**2, rel=1e-12)
    assert springs.cross_diagonal == pytest.approx(
        t * share / 2 * (2 * spacing**2 + lz2) / spacing**2, rel=1e-12
    )
    firmer = 4 if method == "consistent-membrane" else 1
    assert springs.vertical == pytest.approx(4 * firmer * c, rel=1e-12)


def test_uniform_lattice_of_the_theory():
    calibration = lumped.calibrate(SEED.sheet, SEED.material, (9, 9), "uniform")
    k = calibration.springs.axial
    assert k * calibration.layer_distance**2 == pytest.approx(RIGIDITY, rel=1e-12)  # D11 = k lz²
    row = {r["name"]: r["got"] for r in calibration.moduli}
    assert row["D12"] / row["D11"] == pytest.approx(0.5) and row["D66"] / row["D11"] == pytest.approx(0.5)
    miss = {r["name"]: r["miss"] for r in calibration.moduli}
    assert miss["D66"] == pytest.approx(0.923, abs=1e-3)  # 1.92 times what ν = 0.48 requests for


UNEQUAL = SpringSet(
    axial=PerDirection(x=900.0, y=500.0),
    diagonal=300.0,
    vertical=2000.0,
    cross=PerDirection(x=700.0, y=400.0),
    cross_diagonal=150.0,
    area=200.0,
    mid_area=-60.0,
    layer_distance=0.004,
)


@pytest.mark.parametrize("grid, coupling", [((9, 9, 2), 70.0), ((7, 11, 2), -70.0)])
def test_homogenisation_agrees_with_imposed_strains(grid, coupling):
    springs = UNEQUAL.model_copy(
        update={"shear": 120.0, "mid_shear": 90.0, "mid_stretch": PerDirection(x=50.0, y=80.0)}
        | {"face_coupling": coupling}
    )
    cells = each_cell(SEED.sheet, SEED.material, grid)
    assembly = Assembly(SEED.sheet, report("test", cells, Springs.read(springs)))
    spacing = (0.188 / (grid[0] - 1), 0.188 / (grid[1] - 1), 0.004)
    got = moduli.of_springs(springs, spacing, 2)
    zero = (0.0, 0.0, 0.0)
    for strain in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 1.0, 0.0), (1.0, -0.4, 0.3)):
        membrane = imposed_energy(assembly, strain, zero, (0.0, 0.0))
        assert membrane == pytest.approx(0.5 * np.array(strain) @ got.membrane @ strain, rel=1e-4)
        bending = imposed_energy(assembly, zero, strain, (0.0, 0.0))
        assert bending == pytest.approx(0.5 * np.array(strain) @ got.bending @ strain, rel=1e-4)
    assert np.sign(got.coupling) == np.sign(coupling)
    both = got.shear.sum() - 2.0 * got.coupling
    for shear, expected in (((1.0, 0.0), got.shear[0]), ((0.0, 1.0), got.shear[1]), ((1.0, -1.0), both)):
        assert imposed_energy(assembly, zero, zero, shear) == pytest.approx(0.5 * expected, rel=1e-4)


def test_a_law_of_components_has_the_moduli_of_their_mean():
    """Habibi et al.'s, which has no energy."""
    parts = UNEQUAL.model_copy(update={"diagonal": PerDirection(x=150.0, y=300.0, z=450.0)})
    got, expected = (moduli.of_springs(springs, (0.02, 0.03, 0.004), 2) for springs in (parts, UNEQUAL))
    assert got.membrane == pytest.approx(expected.membrane) and got.bending == pytest.approx(expected.bending)


@pytest.mark.sweep
@pytest.mark.parametrize("method", ["consistent", "moduli"])
@pytest.mark.parametrize("grid", [(5, 5), (33, 33), (9, 13), (9, 25), (25, 9)])
def test_every_modulus_is_met(method, grid):
    calibration = lumped.calibrate(SEED.sheet, SEED.material, grid, method)
    within = 1e-9 if method == "consistent" else 1e-5
    assert all(abs(row["miss"]) < within for row in calibration.moduli) and calibration.remarks == ()
    springs = calibration.springs
    links = (springs.axial, springs.diagonal, springs.vertical, springs.cross, springs.cross_diagonal)
    assert all(min(k.x, k.y) > 0.0 if isinstance(k, PerDirection) else k > 0.0 for k in links)


def test_layers_too_many_for_the_grid_are_said():
    fine = lumped.calibrate(SEED.sheet, SEED.material, (65, 65, 3))
    assert all(abs(row["miss"]) < 1e-10 for row in fine.moduli)
    calibration = lumped.calibrate(SEED.sheet, SEED.material, (9, 9, 3))
    assert any("springs miss" in note for note in calibration.remarks)


def test_a_given_layer_distance_is_kept():
    calibration = lumped.calibrate(SEED.sheet, SEED.material, (9, 9), layer_distance=0.0045)
    assert calibration.layer_distance == 0.0045
    assert all(abs(row["miss"]) < 1e-5 for row in calibration.moduli)  # strain springs take up the stretching


def test_cauchy_relation_is_named():
    for method in ("uniform", "cauchy", "central", "axial", "van-gelder", "lloyd"):
        calibration = lumped.calibrate(SEED.sheet, SEED.material, (9, 9), method)
        got = {row["name"]: row["got"] for row in calibration.moduli}
        assert got["D12"] == pytest.approx(got["D66"], rel=1e-12)
        assert any("Cauchy's relation" in note for note in calibration.remarks)


def test_textbook_constructions_on_squares():
    """Published factors: E2 and E2/4 (Van Gelder 1998), 5/16 and 7/16 E2 a cell (Lloyd et al. 2007)."""
    strip = 54.5e6 * 0.003 / 2
    gelder = lumped.calibrate(SEED.sheet, SEED.material, (9, 9), "van-gelder").springs
    assert (gelder.axial, gelder.diagonal) == pytest.approx((strip, strip / 4))
    lloyd = lumped.calibrate(SEED.sheet, SEED.material, (9, 9), "lloyd").springs
    assert (lloyd.axial, lloyd.diagonal) == pytest.approx((2 * 5 / 16 * strip, 7 / 16 * strip))
    bars = lumped.calibrate(SEED.sheet, SEED.material, (9, 9), "axial").springs
    assert (bars.axial, bars.diagonal) == pytest.approx((strip, strip / 2))
    square, upright = (0.188 / 8) ** 2, 0.003**2 / 3  # cross links and their diagonals bear the shear 2 : 1
    assert gelder.cross / gelder.cross_diagonal == pytest.approx(
        4 * (square + upright) / (2 * square + upright)
    )


def test_textbook_constructions_on_oblong_cells():
    """E2 ly/lx along x and E2 lx/ly along y (Van Gelder); K_ij of a rectangle (Lloyd et al.)."""
    strip = 54.5e6 * 0.003 / 2
    gelder = lumped.calibrate(SEED.sheet, SEED.material, (9, 17), "van-gelder").springs.axial
    assert (gelder.x, gelder.y) == pytest.approx((strip / 2, 2 * strip))
    lloyd = lumped.calibrate(SEED.sheet, SEED.material, (9, 13), "lloyd").springs.axial
    # c = E2 · 9/8, c66 = c/3: 2 (c ly/3lx − c66 lx/6ly), 2 (c lx/3ly − c66 ly/6lx) with lx/ly = 3/2
    assert (lloyd.x, lloyd.y) == pytest.approx((strip * 5 / 16, strip * 25 / 24))


def test_a_bend_that_costs_nothing_is_refused():
    bend, stretch = np.diag([1.0, 1.0, 0.0])[None, None], np.eye(3)[None, None]
    costless = moduli.Moduli(stretch, bend, np.ones((1, 1, 2)), np.zeros((1, 1)), 0.0 * bend)
    springs = Springs.made(1e-3, area=-1.0)
    with pytest.raises(BadInput, match="the cell's energy is not positive"):
        report("test", each_cell(SEED.sheet, SEED.material, (9, 9, 2)), springs, cell_moduli=costless)
