"""The calibration of links alone: what its table stands on, what it meets, how much nearer than `cauchy`."""

import numpy as np
import pytest
from cases import with_material

import fem_reference
import lumped
from lumped.calibration.central import coefficients
from lumped.calibration.central_table import ROWS
from sheetbench import scenes
from sheetbench.errors import BadInput
from studies.transfer.training import POINTS, bent_scenes

SEED = scenes.load("two-edges-clamped")


def test_every_row_halves_what_cauchys_moduli_err():
    rows = np.array([row for row in ROWS if row.poisson not in (0.3333,)])
    assert np.all(rows[:, 4] < 0.56 * rows[:, 6])
    assert coefficients(1.0 / 3.0) == pytest.approx([1.0, 1.0 / 3.0, 1.0, 0.0, 0.0, 0.0], abs=1e-3)


@pytest.mark.parametrize("poisson", [0.0, 1.0 / 3.0, 0.48])
@pytest.mark.parametrize("grid", [(5, 5), (9, 13), (33, 33)])
def test_moduli_are_those_of_the_table(poisson, grid):
    material = with_material(SEED, poisson=poisson).material
    found = lumped.calibrate(SEED.sheet, material, grid, "central")
    a, b, c, *_ = coefficients(poisson)
    rows = {row["name"]: row for row in found.moduli}
    rigidity = rows["D11"]["asked"]
    assert rows["D11"]["got"] == pytest.approx(a * rigidity, rel=1e-9)
    assert rows["D66"]["got"] == pytest.approx(b * rigidity, rel=1e-9)
    assert rows["D12"]["got"] == pytest.approx(b * rigidity, rel=1e-9)
    stretching = [rows[name]["got"] for name in ("A11", "A22") if name in rows]
    assert np.exp(np.mean(np.log(stretching))) == pytest.approx(c * rows["A11"]["asked"], rel=1e-9)
    for name in ("S", "Sx", "Sy"):
        assert name not in rows or rows[name]["miss"] == pytest.approx(0.0, abs=1e-9)
    springs = found.springs
    assert not any((springs.area, springs.mid_area, springs.shear, springs.mid_shear, springs.edge_shear))
    assert any("errors on the training scenes" in note for note in found.remarks)


def test_long_cells_keep_nonnegative_links():
    springs = lumped.calibrate(SEED.sheet, SEED.material, (9, 25), "central").springs
    assert springs.axial.x == 0.0 and springs.axial.y > 0.0 and springs.diagonal > 0.0
    with pytest.raises(BadInput, match="3 layers need cells as small"):
        lumped.calibrate(SEED.sheet, SEED.material, (9, 9, 3), "central")


def test_the_lattice_errs_half_as_much_as_cauchys_on_the_scenes_that_bend():
    chosen = ("clamped all round", "two opposite edges hinged", "a force at the free corner")
    posed = [bent_scenes()[name] for name in chosen]
    truths = [fem_reference.solve(scene, "plate", elements=6).displacement(POINTS) for scene in posed]

    def worst(method):
        springs = lumped.calibrate(SEED.sheet, SEED.material, 9, method)
        return max(_error(scene, springs, truth) for scene, truth in zip(posed, truths, strict=True))

    assert worst("central") < 0.1 and worst("central") < 0.65 * worst("cauchy")


def _error(scene, springs, truth):
    found = lumped.solve(scene, springs).displacement(POINTS)
    return float(np.abs(found - truth).max() / np.abs(truth).max())
