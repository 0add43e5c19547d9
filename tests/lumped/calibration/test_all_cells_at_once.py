"""The springs of unequal cells: all at once as each alone, and as before they were found all at once."""

import numpy as np
import pytest

import lumped
from lumped.calibration.cell_by_cell import each_cell
from lumped.calibration.closed_form import springs_of_cells
from lumped.spring_constants import Springs, require_cells
from sheetbench.scenes import BadInput, Material, Scene, Sheet, SpringSet
from sheetbench.scenes.objects.grading import Grading

SIZES = {"length_x": 0.1, "length_y": 0.08, "thickness": 0.003}
PLAIN = {"name": "pinned", "sheet": SIZES, "material": {"young": 5e6, "poisson": 0.35, "density": 1e3}}
MODULI = {"young_1": 20e6, "young_2": 2e6, "poisson_12": 0.3, "shear_12": 1.2e6}
FIBRES = {**PLAIN, "material": {"kind": "orthotropic", **MODULI, "density": 1e3, "angle": 0.5}}
HOLE = {"cutouts": [{"shape": {"circle": {"centre": [0.05, 0.045], "radius": 0.014}}}]}
PATCH = {"patches": [{"shape": {"rectangle": {"x": [0.02, 0.05], "y": [0.01, 0.04]}}, "thickness": 0.004}]}
PLIES = {"layers": [{"thickness": 0.75e-3, "angle": angle} for angle in (0.2, 1.0, 1.0, 0.2)]}
SHEETS = {
    "graded": (PLAIN, (6, 5, 2), 0.5, "consistent"),
    "fibres towards an edge": (FIBRES, (5, 6, 2), Grading(0.4, ("x0",)), "consistent"),
    "laminate with a hole": ({**FIBRES, **PLIES, **HOLE}, (9, 8, 2), 0.0, "consistent"),
    "patch and hole": ({**PLAIN, **PATCH, **HOLE}, (9, 8, 2), 0.3, "consistent-membrane"),
    "rubber": ({**PLAIN, **HOLE}, (8, 8, 3), 0.2, "hyperelastic"),
}
# layer distance [m] and of every constant Σ k_i cos i over the cells [N/m], by the code that took one cell
# after another (commit 1e6b6af0), which rounded widths to twelve digits; rims of the rubber's round hole,
# which that code took along the grid by the cells' stiffness, are named by the sheet's share of cells since
BEFORE = {
    "graded": (
        0.00372380931689,
        "axial_x=1208.314512 axial_y=837.1175347 diagonal=1046.737384 vertical=-1389.772781 "
        "cross_x=1545.059441 cross_y=1137.277922 cross_diagonal=3543.835256 area=-425.9635401 "
        "mid_area=-1700.760897 shear=-478.2711968 mid_shear=-2652.792909 mid_stretch_x=4674.077984 "
        "mid_stretch_y=4626.333504 edge_shear_x=12.28743673 edge_shear_y=-68.07835234 "
        "strip_shear_x=12.28761478 strip_shear_y=-68.06371232",
    ),
    "fibres towards an edge": (
        0.00566402869528,
        "axial_x=172.4621887 axial_y=188.2710522 vertical=6594.312795 cross_x=1861.674972 "
        "cross_y=1752.732444 cross_diagonal=1180.070927 shear=645.3051814 stretch_x=1818.892566 "
        "stretch_y=408.2439167 mid_shear=10449.68834 mid_stretch_x=30492.35705 mid_stretch_y=7616.824355 "
        "coupling_xy=550.9392047 coupling_x=898.5147263 coupling_y=314.4114137 mid_coupling_xy=8952.080336 "
        "mid_coupling_x=17419.93692 mid_coupling_y=6095.645218 edge_shear_x=-4.066083451 "
        "edge_shear_y=-62.84548929 strip_shear_x=-4.066083451 strip_shear_y=-62.84561211 "
        "edge_coupling_x=-0.1550419694 edge_coupling_y=0.1670771557 far_edge_shear_x=1.21391177 "
        "far_edge_shear_y=-62.84548929 far_strip_shear_x=1.21391177 far_strip_shear_y=-62.84561211 "
        "far_edge_coupling_x=-0.1550419694 far_edge_coupling_y=0.1670771557",
    ),
    "laminate with a hole": (
        0.00423547563835,
        "axial_x=1371.047625 axial_y=376.3822888 vertical=11876.66804 cross_x=7631.878997 "
        "cross_y=1749.292555 cross_diagonal=1794.620037 shear=781.6353689 stretch_x=4662.407733 "
        "stretch_y=851.8263866 mid_shear=8864.595708 mid_stretch_x=20825.23173 mid_stretch_y=21926.02891 "
        "coupling_xy=566.0192321 coupling_x=1139.51069 coupling_y=357.0779335 mid_coupling_xy=7656.091858 "
        "mid_coupling_x=10336.62855 mid_coupling_y=12247.70443 edge_shear_x=2.893522689 "
        "edge_shear_y=-42.48837619 strip_shear_x=2.893521853 strip_shear_y=-42.48837619 "
        "edge_coupling_x=0.3202446601 edge_coupling_y=2.125360669 far_edge_shear_x=2.893522689 "
        "far_edge_shear_y=-42.48837619 far_strip_shear_x=2.893521853 far_strip_shear_y=-42.48837619 "
        "far_edge_coupling_x=0.3202446601 far_edge_coupling_y=2.125360669 rim_shear=-13.71185465 "
        "rim_stretch_x=-133.9693143 rim_stretch_y=-11.17876997 rim_coupling_xy=35.59704851 "
        "rim_coupling_x=-37.17190082 rim_coupling_y=7.840910126",
    ),
    "patch and hole": (
        0.00649960709696,
        "axial_x=749.5404347 axial_y=1390.237669 diagonal=613.6070562 vertical=31188.28924 "
        "cross_x=2158.953953 cross_y=4004.3835 cross_diagonal=1467.980877 area=-31.79791587 "
        "mid_area=6327.342091 shear=-71.54345584 mid_shear=5406.240495 mid_stretch_x=10469.8989 "
        "mid_stretch_y=11488.31764 edge_shear_x=-29.89128476 edge_shear_y=-28.25177982 "
        "strip_shear_x=-29.89128437 strip_shear_y=-28.25177693 far_edge_shear_x=-29.89128476 "
        "far_edge_shear_y=-28.25177982 far_strip_shear_x=-29.89128437 far_strip_shear_y=-28.25177693 "
        "rim_shear=-0.6980595936 rim_stretch_x=-3.434192424 rim_stretch_y=-3.402906628 "
        "rim_coupling_xy=3.418059304 rim_coupling_x=1.212900067 rim_coupling_y=-1.212952566",
    ),
    "rubber": (
        0.00106066017178,
        "axial_x=-3532.866708 axial_y=-3703.918117 vertical=-206074.0982 neo_hookean_shear=-3945.66834 "
        "neo_hookean_volume=-9206.55946 face_shear_x=-462.4891178 face_shear_y=-453.0028274 "
        "face_diagonal_shear=-350.3412529 edge_shear_x=-147.8999087 edge_shear_y=-182.1956028 "
        "strip_shear_x=-147.899926 strip_shear_y=-182.195589 far_edge_shear_x=-147.8999087 "
        "far_edge_shear_y=-182.1956028 far_strip_shear_x=-147.899926 far_strip_shear_y=-182.195589",
    ),
}


def calibrated(name):
    document, grid, grading, method = SHEETS[name]
    scene = Scene.model_validate(document)
    cells = lumped.sections_of(scene, grid, grading)
    return lumped.calibrate(scene.sheet, scene.material, grid, method, grading=grading, cells=cells)


def of_all_cells(table):
    """Every constant that is not 0 by name and direction, its cells in a row."""
    for name, value in table:
        parts = (
            {f"{name}_{axis}": getattr(value, axis) for axis in "xy"}
            if hasattr(value, "x")
            else {name: value}
        )
        yield from ((key, np.ravel(part).astype(float)) for key, part in parts.items() if np.any(part))


@pytest.mark.parametrize("name", SHEETS)
def test_springs_are_as_before(name):
    distance, constants = BEFORE[name]
    springs = calibrated(name).springs
    found = {key: part @ np.cos(np.arange(len(part))) for key, part in of_all_cells(springs)}
    size = {key: np.abs(part).max() for key, part in of_all_cells(springs)}
    assert found.pop("layer_distance") == pytest.approx(distance, rel=1e-9)
    before = {key: float(value) for key, _, value in (each.partition("=") for each in constants.split())}
    assert found.keys() == before.keys()
    for key, value in before.items():
        assert found[key] == pytest.approx(value, abs=1e-8 * size[key]), key


@pytest.mark.parametrize("gradients", [False, True])
def test_a_cells_springs_are_those_of_a_sheet_of_such_cells(gradients):
    """Whatever cells are beside it: no cell's fixed point, fibres or bounds reach another's."""
    scene = Scene.model_validate({**FIBRES, **PATCH})
    grid = (7, 6, 2)
    each = each_cell(scene.sheet, scene.material, grid, 0.7, lumped.sections_of(scene, grid, 0.7))
    springs = springs_of_cells(each, gradients=gradients)
    for row, column in ((0, 0), (1, 2), (2, 1), (4, 5)):
        at = slice(row, row + 1), slice(column, column + 1)
        one = each._replace(sides=each.sides[at], section=each.section.each(lambda part, at=at: part[at]))
        one = one._replace(there=each.there[at])
        alone = springs_of_cells(one, springs.layer_distance, gradients=gradients)
        for name, values in springs.of.items():
            for axis in (0, 1):
                mine, own = springs.along(name, axis)[row, column], alone.along(name, axis)[0, 0]
                assert mine == pytest.approx(own, rel=1e-12, abs=1e-12 * np.abs(values).max()), name


@pytest.mark.parametrize("name", SHEETS)
def test_a_table_is_read_as_it_was_written(name):
    found = calibrated(name)
    table = SpringSet.model_validate(found.springs.model_dump())
    assert table == found.springs == Springs.read(table).table()
    require_cells(table, found.grid, "")
    with pytest.raises(BadInput, match="cells are wanted on"):
        require_cells(table, (found.grid[0] + 1, *found.grid[1:]), "")


def test_an_even_sheet_is_calibrated_once():
    """A second call costs no closed form; another sheet has its own."""
    sheet, material = Sheet(0.1, 0.1, 0.002), Material(1e6, 0.3, 1e3)
    first = lumped.calibrate(sheet, material, 5)
    assert lumped.calibrate(sheet, material, 5) is first
    assert lumped.calibrate(sheet.replace(thickness=0.003), material, 5).springs != first.springs


def test_constructions_of_the_literature_say_what_they_miss_of_fibres_at_an_angle():
    """It ended in a KeyError: their lattices have no D16 to compare."""
    scene = Scene.model_validate(FIBRES)
    found = lumped.calibrate(scene.sheet, scene.material, (6, 6), "lloyd")
    assert {"D16", "A26"} <= {row["name"] for row in found.moduli} and "D16 by" in found.remarks[0]
