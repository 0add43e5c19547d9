"""Homogenisation: the plate moduli of a lattice, from the energy of its unit cell in closed form.

A link of rest vector d (length L) and stiffness k stores ½ k (d·E d / L)². With the in-plane strain
(ε_x, ε_y, γ_xy) at its mid-height, the stretch of its gap ε_z and the transverse shears γ_x, γ_y:

    d·E d = dx² ε_x + dy² ε_y + dx dy γ_xy + dz² ε_z + dx dz γ_x + dy dz γ_y.

Summed over a cell of area lx ly this gives a 6×6 form per layer (dz = 0, with the area spring) and per
gap between layers. Layers at z_k and gaps at z_g add up, with ε_z of each gap relaxed, to

    A = Σ_k C + Σ_g G + m 1 1ᵀ,     D = Σ_k z_k² C + Σ_g z_g² G,     S = Σ s_g  (see below),

where C is a layer's 3×3 form and G a gap's after relaxation. Under a transverse force the gaps carry
shear in proportion to t_g = Σ_{k above g} z_k (equilibrium of the layers), so that the shear stiffness
is (Σ t_g)²/Σ t_g² times one gap's: 1 for two layers, 2 for three.

The sheet itself has D_ij and A_ij of an isotropic plane-stress plate and, on a grid of spacing l,
MacNeal's (1978) residual-bending shear stiffness 1/S* = 1/(κ G h) + l²/(12 D), κ = 5/6, which makes the
one-point sheared lattice exact for cubic deflections. Stiffness per length: A, S [N/m], D [N·m].
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lumped import spring_constants as constants
from lumped.lattice import STEPS
from lumped.sections import ROUNDING, Section
from sheetbench.scenes import Constants, Material, Sheet, SpringSet


@dataclass(frozen=True)
class Moduli:
    """In-plane forms A [N/m] and D [N·m], (3, 3) over (x, y, xy); shear stiffness S (2,) [N/m]."""

    membrane: np.ndarray
    bending: np.ndarray
    shear: np.ndarray

    @property
    def oblique(self) -> bool:
        """Whether stretching along the sides shears: fibres are at an angle to them."""
        return any(
            np.abs(form[:2, 2]).max() > ROUNDING * form[0, 0] for form in (self.membrane, self.bending)
        )

    def named(self, square: bool) -> dict[str, float]:
        """The moduli by name; on square cells the x and y values are one."""
        a, d = self.membrane, self.bending
        names = {
            "D11": d[0, 0],
            "D12": d[0, 1],
            "D66": d[2, 2],
            "A11": a[0, 0],
            "A12": a[0, 1],
            "A66": a[2, 2],
        }
        if self.oblique:
            names |= {"D16": d[0, 2], "D26": d[1, 2], "A16": a[0, 2], "A26": a[1, 2]}
        if square:
            return {**names, "S": self.shear[0]}
        return {**names, "D22": d[1, 1], "A22": a[1, 1], "Sx": self.shear[0], "Sy": self.shear[1]}


def link_forms(spacing: tuple[float, float, float]) -> dict[tuple[str, str], np.ndarray]:
    """Energy form per unit stiffness and area of each family and direction: (6, 6) over
    (ε_x, ε_y, γ_xy, ε_z, γ_x, γ_y), energy density ½ ε·Q ε [1: m/m² · m]."""
    lx, ly, lz = spacing
    forms: dict[tuple[str, str], np.ndarray] = {}
    for family, direction, step in STEPS:
        dx, dy, dz = step[0] * lx, step[1] * ly, step[2] * lz
        row = np.array([dx * dx, dy * dy, dx * dy, dz * dz, dx * dz, dy * dz])
        form = np.outer(row, row) / ((dx * dx + dy * dy + dz * dz) * lx * ly)
        forms[family, direction] = forms.get((family, direction), np.zeros((6, 6))) + form
    return forms


def gap_shear_per_stiffness(spacing: tuple[float, float, float]) -> tuple[float, float, np.ndarray]:
    """Shear stiffness of one gap per unit stiffness of cross links along x, along y, and (2,) of the furthest
    diagonals along x and y [1]."""
    forms = link_forms(spacing)
    diagonals = forms["cross_diagonal", ""]
    return forms["cross", "x"][4, 4], forms["cross", "y"][5, 5], np.array([diagonals[4, 4], diagonals[5, 5]])


def shear_gaps(layers: int) -> float:
    """(Σ t_g)²/Σ t_g², t_g = g (L − g)/2: the sheet's shear stiffness in units of one gap's."""
    return 5 * layers * (layers**2 - 1) / (6 * (layers**2 + 1))


def second_moment(layers: int) -> float:
    """Σ z_k² of layers one apart, about their middle; of the gaps between L layers that of L − 1."""
    return layers * (layers**2 - 1) / 12


def of_springs(springs: SpringSet, spacing: tuple[float, float, float], layers: int) -> Moduli:
    """Moduli of an interior patch of the lattice with these springs, alike in all cells."""
    layer, gap = np.zeros((6, 6)), np.zeros((6, 6))
    for (family, direction), form in link_forms(spacing).items():
        k = np.mean(constants.along(springs, family, direction))
        if family in ("axial", "diagonal"):
            layer += k * form
        else:
            gap += k * form
    dilation = np.zeros((3, 3))
    dilation[:2, :2] = 1.0
    in_layer = layer[:3, :3] + springs.area * dilation
    in_layer += _of_strains(springs, "area")
    if springs.rubber:
        area = spacing[0] * spacing[1]
        sides = np.array([[[spacing[0], 0.0, 0.0], [0.0, spacing[1], 0.0]]])
        ((volume, *strains),), _ = constants.of_rubber(springs, sides, np.array([area]), np.zeros(1))
        in_layer += volume * dilation + np.diag(strains)
    mid_surface = springs.mid_area * dilation + _of_strains(springs, "mid_area")
    in_gap = gap[:3, :3].copy()
    if gap[3, 3] > 0.0:
        in_gap -= np.outer(gap[:3, 3], gap[:3, 3]) / gap[3, 3]
    return Moduli(
        membrane=layers * in_layer + (layers - 1) * in_gap + mid_surface,
        bending=(second_moment(layers) * in_layer + second_moment(layers - 1) * in_gap) * spacing[2] ** 2,
        shear=shear_gaps(layers) * (np.diag(gap)[4:] + sum(constants.of_faces(springs, spacing[:2]))),
    )


def _of_strains(springs: SpringSet, cells: str) -> np.ndarray:
    """The form (3, 3) of strain springs and couplings."""
    ((x, y, shear, xy, x_shear, y_shear),) = constants.of_strains(springs, cells)[1]
    return np.array([[x, xy, x_shear], [xy, y, y_shear], [x_shear, y_shear, shear]])


def of_section(section: Section, spacing: tuple[float, float]) -> Moduli:
    """Moduli of a section, with MacNeal's S* of the in-plane spacing (lx, ly) [m] as the shear stiffness."""
    shear = [
        1.0 / (1.0 / section.shear[a] + length**2 / (12.0 * section.bending[a, a]))
        for a, length in enumerate(spacing)
    ]
    return Moduli(section.membrane, section.bending, np.array(shear))


def of_sheet(sheet: Sheet, material: Material, spacing: tuple[float, float]) -> Moduli:
    """Moduli of the sheet, with MacNeal's S* as `of_section`."""
    return of_section(Section.of(Constants.of(sheet, material)), spacing)
