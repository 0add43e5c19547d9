"""What a rim at an angle to the grid lets go: the twisting moment in its own axes."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from cases import calibrated
from scipy.sparse.linalg import spsolve

import lumped
from lumped import moduli
from lumped.assembly import Assembly
from lumped.spring_constants import Springs, of_edge_cells
from sheetbench.scenes import Cells, Scene, SpringSet
from sheetbench.scenes.objects.grid import grid_of
from studies.transfer.drawn_scenes import drawn

THICKNESS, ACROSS, ALONG = 1e-3, 16, 60  # of strips; their sides in cells
RUBBER = {"young": 1e6, "poisson": 0.45, "density": 1e3}
MODULI = {"young_1": 20e6, "young_2": 2e6, "poisson_12": 0.3, "shear_12": 1.2e6}
FIBRES = {"kind": "orthotropic", "density": 1e3, **MODULI}


class Strip:
    """A strip of ACROSS × ALONG cells of `size` [m] that is cut out of its grid at an angle [degrees]."""

    def __init__(self, angle, size, material):
        t = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
        n = np.array([-t[1], t[0]])
        corners = np.array([[0, 0], [ALONG, 0], [ALONG, ACROSS], [0, ACROSS]]) * size @ np.array([t, n])
        corners -= corners.min(axis=0)
        box, self.middle, self.axes, self.size = corners.max(axis=0), corners.mean(axis=0), (t, n), size
        sheet = {"length_x": box[0], "length_y": box[1], "thickness": THICKNESS, "outline": corners.tolist()}
        place = {"circle": {"centre": self.middle.tolist(), "radius": size}}
        support = [{"kind": "clamped", "where": place}]
        keys = {"name": "strip", "sheet": sheet, "material": material, "support": support}
        self.scene = Scene.model_validate(keys)
        self.grid = (*(int(n) + 1 for n in np.round(box / size)), 2)
        whole = lumped.sections.of_cells(Cells.of(self.scene.sheet, self.scene.material), self.grid)
        # D over along, across and twice the twist
        turned = [[*(a * b), a[0] * b[1] + a[1] * b[0]] for a, b in ((t, t), (n, n), (n, t))]
        self.bending = np.array(turned) @ whole.bending[0, 0] @ np.array(turned).T

    def springs(self, method):
        """What rims let go at the strip's sides, not at its ends."""
        lines = lumped.grid_lines.grid_lines(self.scene.sheet, self.grid)
        share = lumped.sections.shares_of(self.scene.region, *(side.at for side in lines))
        whole = lumped.sections.of_cells(Cells.of(self.scene.sheet, self.scene.material), self.grid)
        rims = lumped.coverage.oblique_rims(self.scene, lines, share)
        x, y = (0.5 * (side.at[1:] + side.at[:-1]) for side in lines)
        along = (np.stack([x[rims.columns], y[rims.rows]], axis=1) - self.middle) @ self.axes[0]
        sides = np.abs(along) < (0.5 * ALONG - 3.0) * self.size
        cells = replace(whole.map(lambda part: part * share.reshape(*share.shape, *(1,) * (part.ndim - 2))))
        cells = replace(cells, rims=type(rims)(*(part[sides] for part in rims)), share=share)
        return lumped.calibrate(self.scene.sheet, self.scene.material, self.grid, method, cells=cells)

    def energies(self, springs, curvature, lengths):
        """Of the lattice [J] whose masses farther than half a length [cells] from the middle are held at a
        curvature along, across, and twice the twist."""
        assembly = Assembly(self.scene.sheet, springs)
        position, lattice = assembly.lattice.positions, assembly.lattice
        (t, n), z = ((position[:, :2] - self.middle) @ axis for axis in self.axes), position[:, 2]
        along, across, twist = curvature
        turned = [z * (along * t + 0.5 * twist * n), z * (across * n + 0.5 * twist * t)]
        u = np.zeros_like(position)
        u[:, :2] = np.outer(turned[0], self.axes[0]) + np.outer(turned[1], self.axes[1])
        u[:, 2] = -0.5 * (along * t**2 + across * n**2 + twist * t * n)
        u[lattice.absent_masses] = 0.0
        pattern = assembly.pattern
        blocks = assembly.tangent(np.zeros_like(u))
        tangent = sp.csr_array(sp.bsr_array((blocks, pattern.indices, pattern.indptr)))
        found = []
        for length in lengths:
            free = np.abs(t) < 0.5 * length * self.size
            free[lattice.absent_masses] = False
            free, moved = np.repeat(free, 3), u.ravel().copy()
            if free.any():
                pull = tangent[free][:, ~free] @ moved[~free]
                moved[free] = spsolve(tangent[free][:, free].tocsc(), -pull)
            found.append(0.5 * moved @ (tangent @ moved))
        return found


def lost(strip, method):
    """The width that a side loses where the strip is twisted and does not bend along itself [m]."""
    d = strip.bending
    twist = np.array([0.0, -d[1, 2] / d[1, 1], 1.0])
    stored = 0.5 * twist @ d @ twist
    held, short, long = strip.energies(strip.springs(method), twist, (0, 16, 36))
    interior, *_ = strip.energies(strip.springs("consistent-interior"), twist, (0,))
    taken = (interior - held) / (ALONG - 6)  # what the sides' cells have less, twisted alike
    return (taken + (short - long) / 20) / (2.0 * stored * strip.size)


@pytest.mark.sweep
@pytest.mark.parametrize("angle", [10.0, 26.565, 45.0])
@pytest.mark.parametrize("cells, without", [(0.5, 0.18), (1.0, 0.33), (2.0, 0.39)])
def test_a_strip_at_any_angle_loses_the_width_of_twist_that_a_plate_loses(angle, cells, without):
    """h/√10 a side, within 8 % in cells of half to twice the thickness; without it 18 to 45 % less."""
    strip = Strip(angle, cells * THICKNESS, RUBBER)
    target = THICKNESS / np.sqrt(10.0)
    assert lost(strip, "consistent") == pytest.approx(target, rel=0.08)
    assert lost(strip, "consistent-interior") < (1.0 - without) * target


@pytest.mark.sweep
@pytest.mark.parametrize("angle, fibres", [(20.0, 60.0), (45.0, 10.0), (45.0, 60.0)])
def test_so_it_does_with_fibres_at_an_angle(angle, fibres):
    """√(D̃66/S), within 2 % in cells half as long as the sheet is thick; without it 7 to 10 % less."""
    strip = Strip(angle, 0.5 * THICKNESS, FIBRES | {"angle": np.radians(fibres)})
    d, shear = strip.bending, 5.0 / 6.0 * FIBRES["shear_12"] * THICKNESS
    target = np.sqrt((d[2, 2] - d[1, 2] ** 2 / d[1, 1]) / shear)
    assert lost(strip, "consistent") == pytest.approx(target, rel=0.02)
    assert lost(strip, "consistent-interior") < 0.94 * target


def test_a_moment_along_the_rim_bends_the_strip_as_it_bends_the_sheet():
    for angle, fibres in ((10.0, 30.0), (30.0, 60.0), (45.0, 10.0), (70.0, 0.0)):
        strip = Strip(angle, 2.0 * THICKNESS, FIBRES | {"angle": np.radians(fibres)})
        curvature = np.linalg.solve(strip.bending, [1.0, 0.0, 0.0])
        springs = strip.springs("consistent")
        assert np.any(springs.springs.rim_shear)
        (energy,) = strip.energies(springs, curvature, (0,))
        area = strip.scene.region.area
        assert energy == pytest.approx(0.5 * curvature @ strip.bending @ curvature * area, rel=1e-7)


SHAPES = ("octagon", "parallelogram", "round-hole", "hole-on-lines")
SHEETS = [scene for scene in drawn() if scene.name in SHAPES]


@pytest.mark.parametrize("scene", SHEETS, ids=lambda scene: scene.name)
@pytest.mark.parametrize("masses", [9, 33])
def test_every_cell_keeps_a_positive_energy_and_the_table_is_read_back(scene, masses):
    """At corners, where what sides take adds up, and in cells a sixth as long as the sheet is thick."""
    found = calibrated(scene.replace(thickness=6.0 * scene.sheet.thickness), masses).springs
    rows, columns = np.nonzero(np.array(found.axial.x if hasattr(found.axial, "x") else found.axial))
    edges = frozenset({"x0", "x1", "y0", "y1"})
    grid = (*grid_of(scene.sheet, masses)[:2], 2)
    rims = of_edge_cells(Springs.read(found), grid, edges).reshape(grid[1] - 1, grid[0] - 1, 6)[rows, columns]
    assert rims.any()
    least = []
    sides = (np.array(scene.sheet.lengths) / np.subtract(grid[:2], 1))[None, None]
    each = moduli.of_cells(Springs.read(found), sides, 2).bending
    for row, column, (xx, yy, ss, xy, xs, ys) in zip(rows, columns, rims, strict=True):
        whole = each[row, column]
        own = np.array([[xx, xy, xs], [xy, yy, ys], [xs, ys, ss]]) * found.layer_distance**2 / 2
        least.append(np.linalg.eigvalsh(whole + own)[0] / np.linalg.eigvalsh(whole)[0])
    assert min(least) > 0.05
    assert SpringSet.model_validate(found.model_dump()) == found
