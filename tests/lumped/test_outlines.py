"""Lattices of sheets with outlines and cutouts, held and loaded where shapes say."""

import numpy as np
import pytest
from cases import calibrated, relative

import lumped
from lumped.assembly import Assembly
from sheetbench.answers.solution import Status
from sheetbench.scenes import BadInput, Scene
from sheetbench.scenes.meaning.composition import mass_of

MATERIAL = {"young": 5e6, "poisson": 0.4, "density": 1e3}
CLAMP = {"kind": "clamped", "edge": "x0"}
WEIGHT = {"acceleration": (0.0, 0.0, -0.01)}
SQUARE = {"rectangle": {"x": (0.05, 0.1), "y": (0.025, 0.075)}}
DISC = {"circle": {"centre": (0.083, 0.047), "radius": 0.03}}
SKEW = [(0.0, 0.0), (0.13, 0.0), (0.2, 0.1), (0.07, 0.1)]
TRAPEZOID = [(0.0, 0.0), (0.2, 0.023), (0.2, 0.081), (0.0, 0.1)]


def sheet(cutout=(), outline=None, gravity=WEIGHT, **keys):
    sides = {"length_x": 0.2, "length_y": 0.1, "thickness": 0.003, "outline": outline}
    scene = {"name": "drawn", "sheet": sides, "material": MATERIAL, "support": [CLAMP], "cutout": cutout}
    return Scene(**{**scene, "gravity": gravity, **keys})


def deflections(scene, across, linear=True):
    solution = lumped.solve(scene, calibrated(scene, across), linear=linear)
    assert solution.status is Status.CONVERGED and solution.balance.holds
    return solution.displacement(scene.probe_points())


def test_absent_cells_have_no_springs_no_mass_and_no_unknowns():
    scene = sheet([{"shape": SQUARE}])  # on lines of the grid
    calibration = calibrated(scene, 9)
    problem = lumped.statics.solver.build_problem(scene, calibration)
    lattice = problem.assembly.lattice
    assert (~lattice.present).sum() == 4 * 4 and len(lattice.absent_masses) == 2 * 3 * 3
    touched = np.concatenate([family.nodes.reshape(-1) for family in problem.assembly.springs])
    assert not np.isin(lattice.absent_masses, touched).any()
    assert problem.system.unknowns == 3 * (lattice.mass_count - 2 * 9 - 2 * 3 * 3)
    for distribution in ("tributary", "gregory"):
        masses = lumped.masses.masses(scene, lattice, distribution, calibration.cells)
        assert masses.sum() == pytest.approx(mass_of(scene)) and not masses[lattice.absent_masses].any()
    solution = lumped.solve(scene, calibration)
    quads = dict(solution.mesh.cells)["quad"]
    assert len(quads) == 2 * lattice.present.sum()
    stored = sum(each.sum() for each in solution.mesh.cell_data["elastic_energy"])
    assert stored == pytest.approx(sum(solution.energies.values()))


@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    ("scene", "order", "within"),
    [
        (sheet([{"shape": SQUARE}]), 1.2, 0.012),
        (sheet([{"shape": DISC}]), 1.0, 0.01),
        (sheet(outline=TRAPEZOID), 1.2, 0.002),
        (sheet(outline=SKEW, support=[{**CLAMP, "edge": "y0"}]), 1.0, 0.02),
    ],
    ids=["aligned hole", "round hole", "trapezoid", "parallelogram"],
)  # fmt: skip
def test_the_error_falls_with_the_cells(scene, order, within):
    """Between 9, 17 and 33 masses on the shorter side, against Richardson's limit of order 2."""
    coarse, middle, fine = (deflections(scene, across) for across in (9, 17, 33))
    limit = fine + (fine - middle) / 3.0
    errors = [relative(each, limit) for each in (coarse, middle)]
    assert errors[1] < within and errors[0] / errors[1] > 2.0**order


def test_a_square_with_a_round_hole_is_pulled_as_kirsch_has_it():
    """Beside the hole the sheet stretches 3.14 times as much as far away: Kirsch's 3, for a hole of a fifth
    of the width as Howland has it, Phil. Trans. R. Soc. A 229 (1930)."""
    side, radius, stretch = 0.1, 0.02, 1e-3
    scene = Scene(
        name="kirsch",
        sheet={"length_x": side, "length_y": side, "thickness": 0.001},
        material=MATERIAL,
        cutout=[{"shape": {"circle": {"centre": (0.0, 0.0), "radius": radius}}}],
        support=[{"kind": "symmetric", "edge": "x0"}, {"kind": "symmetric", "edge": "y0"},
                 {"kind": "held", "edge": "x1", "components": ["z"]}],
        load=[{"kind": "edge", "edge": "x1", "force_per_length": (5e3 * stretch, 0.0, 0.0)}],
        probes={"P": (side, side)},
    )  # fmt: skip
    solution = lumped.solve(scene, calibrated(scene, 41), linear=True)
    assert solution.status is Status.CONVERGED
    beside = side / 40.0  # a cell
    assert solution.displacement([[beside, radius]])[0, 0] / beside == pytest.approx(3.14 * stretch, rel=0.04)


def test_loads_where_a_shape_says():
    """Small pressure and force per area on one part are the same load, and sum up to its area."""
    where = {"circle": {"centre": (0.15, 0.06), "radius": 0.031}}
    area = np.pi * 0.031**2
    pressed, pushed = (
        sheet([{"shape": SQUARE}], gravity=None, load=[one])
        for one in (
            {"kind": "pressure", "value": 1e-3, "where": where},
            {"kind": "area", "force_per_area": (0.0, 0.0, 1e-3), "where": where},
        )
    )
    for scene in (pressed, pushed):
        solution = lumped.solve(scene, calibrated(scene, 9))
        assert solution.reactions["x0"][2] == pytest.approx(-1e-3 * area, rel=1e-4)
    first, second = (deflections(scene, 9, linear=False) for scene in (pressed, pushed))
    assert np.allclose(first, second, rtol=0.0, atol=0.01 * np.abs(second).max())


def test_a_clamp_on_a_part_is_a_shorter_sheet():
    """Its side on a line of the grid or not: what it holds is rigid."""
    grip = {"kind": "clamped", "where": {"rectangle": {"x": (0.0, 0.05), "y": (0.0, 0.1)}}}
    held = sheet(support=[grip], probes={"P": (0.2, 0.05)})
    short = sheet(probes={"P": (0.15, 0.05)}).replace(length_x=0.15, probes={"P": (0.15, 0.05)})
    springs = lumped.calibrate(short.sheet, short.material, (13, 9, 2))
    expected = lumped.solve(short, springs, linear=True).displacement([[0.15, 0.05]])
    solution = lumped.solve(held, lumped.calibrate(held.sheet, held.material, (17, 9, 2)), linear=True)
    assert solution.displacement([[0.2, 0.05]]) == pytest.approx(expected, rel=1e-3)
    assert list(solution.reactions) == ["support 1"]
    assert solution.reactions["support 1"][2] == pytest.approx(0.01 * mass_of(held))
    for side in (0.042, 0.0465):  # nearer to the one line or to the other
        grip["where"]["rectangle"]["x"] = (0.0, side)
        scene = sheet(support=[grip], probes={"P": (0.2, 0.05)})
        short = sheet().replace(length_x=0.2 - side, probes={"P": (0.2 - side, 0.05)})
        springs = lumped.calibrate(short.sheet, short.material, (27, 17, 2))
        expected = lumped.solve(short, springs, linear=True).displacement(short.probe_points())[0, 2]
        assert deflections(scene, 17)[0, 2] == pytest.approx(expected, rel=0.005)
    small = {"kind": "clamped", "where": {"circle": {"centre": (0.006, 0.006), "radius": 1e-3}}}
    with pytest.raises(BadInput, match=r"support 1.where: circle .* holds no mass of a grid of 17x9"):
        lumped.solve(sheet(support=[small]), calibrated(held, 9))


def test_cells_that_are_alike_are_refused_for_a_sheet_with_a_hole():
    scene = sheet([{"shape": SQUARE}])
    with pytest.raises(BadInput, match=r"cutout: the calibration consistent .* cells=lumped.sections_of"):
        lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, 9))
    with pytest.raises(BadInput, match="there is no sheet"):
        lumped.solve(scene, calibrated(scene, 9)).displacement([[0.075, 0.05]])


def test_the_twist_of_rims_is_that_of_edges():
    """A cutout that leaves a smaller rectangle: its rim has what a sheet of that size has at its edges."""
    cut = sheet([{"shape": {"rectangle": {"x": (0.1, 0.3), "y": (-1.0, 1.0)}}}])
    small = sheet().replace(length_x=0.1)
    whole = lumped.calibrate(small.sheet, small.material, (9, 9, 2))
    assembled = [
        Assembly(scene.sheet, springs, twisting=frozenset({"x1", "y0", "y1"}))
        for scene, springs in ((cut, calibrated(cut, 9)), (small, whole))
    ]
    rng = np.random.default_rng(0)
    u = 1e-5 * rng.standard_normal((9, 9, 2, 3))
    beyond = np.zeros((9, 17, 2, 3))
    beyond[:, :9] = u
    cut, alone = (a.force(v.reshape(-1, 3))[0] for a, v in zip(assembled, (beyond, u), strict=True))
    assert cut == pytest.approx(alone, rel=1e-6)
