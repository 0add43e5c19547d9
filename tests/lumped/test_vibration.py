"""Natural frequencies of the lattice: thin-plate values, rigid motions, mass distributions."""

import numpy as np
import pytest

import lumped
from sheetbench.scenes import Clamped, Material, Scene, Sheet

SIDE, YOUNG, DENSITY = 1.0, 1e9, 1000.0
# ω a² √(ρh/D), converged thin plate, ν = 0.3 (Leissa 1973 set-ups)
CANTILEVER = [3.471, 8.507, 21.28, 27.20, 30.95, 54.18]
TWO_EDGES = [6.919, 23.90, 26.58, 47.64, 62.70, 65.53]


def plate(*edges, thickness=0.0005):
    return Scene(
        name="plate",
        sheet=Sheet(length_x=SIDE, length_y=SIDE, thickness=thickness),
        material=Material(young=YOUNG, poisson=0.3, density=DENSITY),
        supports=tuple(Clamped(edge=edge) for edge in edges),
    )


def parameters(scene, masses, count=6, distribution="tributary"):
    """ω a² √(ρh/D) of the lattice."""
    springs = lumped.calibrate(scene.sheet, scene.material, (masses, masses))
    thickness = scene.sheet.thickness
    rigidity = YOUNG * thickness**3 / 12 / (1 - 0.3**2)
    omega = 2 * np.pi * lumped.modes(scene, springs, count, distribution).frequencies
    return omega * SIDE**2 * np.sqrt(DENSITY * thickness / rigidity)


@pytest.mark.parametrize(("edges", "right"), [(("x0",), CANTILEVER), (("x0", "y0"), TWO_EDGES)])
def test_gregory_masses_cut_the_error_of_coarse_grids(edges, right):
    plain = np.abs(parameters(plate(*edges), 9) / right - 1)[:3]
    corrected = np.abs(parameters(plate(*edges), 9, distribution="gregory") / right - 1)[:3]
    assert (corrected < 0.01).all() and corrected.max() < 0.4 * plain.max()


def test_a_free_sheet_has_six_rigid_motions_and_no_spurious_mode():
    """Spurious zero-energy motions of the lattice would show as further frequencies near zero."""
    scene = plate()
    assert lumped.modes(scene, lumped.calibrate(scene.sheet, scene.material, (9, 9)), 1).rigid == 6
    lowest = parameters(scene, 9, 1, "gregory")[0]
    assert lowest == pytest.approx(13.47, rel=0.02)  # Leissa 1973, free square plate


def test_dense_and_sparse_eigensolvers_agree(monkeypatch):
    """To the rounding of K, ε λ_max/λ of the lowest elastic λ: 2e-9 with an edge clamped, 2e-10 free."""
    scene = plate("x0", thickness=0.005)
    dense = parameters(scene, 9)
    monkeypatch.setattr("sheetbench.numerics.eigenmodes.DENSE", 0)
    assert parameters(scene, 9) == pytest.approx(dense, rel=1e-8)
    springs = lumped.calibrate(scene.sheet, scene.material, (9, 9))
    free = plate(thickness=0.005)
    sparse = lumped.modes(free, springs, 3).frequencies
    monkeypatch.setattr("sheetbench.numerics.eigenmodes.DENSE", 10**6)
    assert sparse == pytest.approx(lumped.modes(free, springs, 3).frequencies, rel=1e-8)


@pytest.mark.parametrize("dense", [600, 0])
def test_a_lattice_gives_every_mode_that_it_has_and_no_more(dense, monkeypatch):
    monkeypatch.setattr("sheetbench.numerics.eigenmodes.DENSE", dense)
    scene = plate("x0")
    springs = lumped.calibrate(scene.sheet, scene.material, (3, 3))
    unknowns = lumped.modes(scene, springs, 1).unknowns
    found = lumped.modes(scene, springs, unknowns).frequencies
    assert len(found) == unknowns and found[0] > 0.0 and (np.diff(found) >= 0.0).all()
    for count in (0, unknowns + 1):
        with pytest.raises(ValueError, match=f"count = {count}: 1 to {unknowns} on this lattice"):
            lumped.modes(scene, springs, count)
