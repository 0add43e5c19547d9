"""Distribution of the sheet's mass over the lumped masses.

tributary     each mass has the sheet around it: ½ on edges, ¼ at corners. The trapezoidal rule for the
              inertia ∫ ρh f g of two motions, whose error is l²/12 [(f g)′] from end to end: nothing at a
              clamped edge, but too much inertia at one that moves, and frequencies come out too low.
gregory       Gregory's end-corrected weights, for equal cells 5/12, 13/12, 1, … along each side: the total is
              unchanged, and the error vanishes where f g changes little over the first two cells. The form
              for unequal cells is

                  Σ_j m_j (f g)_j − Σ_j c_j (f g)′_j

              with the c below and the slope (f g)′ over the wider of both cells, so that no mass is light.
              No neighbours share mass: explicit steps use Gregory's masses too.
higher-order  the error vanishes for all f and g, for which neighbours along an edge share mass: with the
              slopes s_j of lines j, difference quotients over the cells beside it, b_left and b_right wide,

                  M = Σ_j m_j e_j e_jᵀ − Σ_j c_j (e_j s_jᵀ + s_j e_jᵀ),    c_j = (b_left² − b_right²)/12

              along x and along y, and for the plan their Kronecker product. Equal cells have c = ± l²/12 at
              the ends alone, and c = 0 at an end where the director is held and f g has no slope. The
              interior needs no correction: with S* (`lumped.moduli`) tributary masses carry a bending
              wave of wave number q across the cells with ω² = D q⁴/ρh (1 − (q l)⁴/720 + …).
              The rule is right in l² and for motions f, g that are linear. A coefficient of l³ is free,

                  M += l³/24 (e₁ κ₁ᵀ + κ₁ e₁ᵀ),    κ₁ the second difference quotient at the first inner line,

              with which the rule is off as if s were the slope there; beside a narrower second cell b it is
              l b²/24, as M is not positive definite with l > 3.8 b otherwise. Free edges have it: their
              inertia is then l³/6 f g″ too large instead of half of it, against springs that are too stiff
              along them (docs/theory.md).
              Across the thickness L layers at the heights z_k share mass so that a director that turns has
              the sheet's rotary inertia ρ h³/12, not ρ h Σ z_k²/L:

                  M_z = 1/L − (1/L − h²/(12 Σ z_k²)) z zᵀ/Σ z_k²,

              for two layers ½ (1 ± h²/(3 lz²))/2 on and beside the diagonal.

Motion in time has Gregory's masses (`lumped.dynamics.system`): tributary ones make a free swing of the
one-edge sheet 3.2 % wrong on 9 × 9 masses, Gregory's 0.5 % (docs/theory.md). `lumped.modes` has the
higher-order ones. Weight stays tributary: static deflections were calibrated with it. Only the weight of a
sheet without supports, which has no statics, is distributed like its inertia (`lumped.loads`), or the sheet
would bend in its fall.
Source: Gregory's and the corrected trapezoidal rule: Hildebrand, Introduction to Numerical Analysis, 5.9;
the form for two motions derived for this project (docs/theory.md).
"""

from typing import Literal

import numpy as np
import scipy.sparse as sp

from lumped.grid_lines import Lines
from lumped.lattice import Lattice
from lumped.payloads import point_masses
from lumped.sections import CellSection
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.composition import of_sheet
from sheetbench.scenes.objects.springs import Distribution
from sheetbench.scenes.objects.supports import held_axes

Inertia = Distribution | Literal["higher-order"]


def masses(
    scene: Scene, lattice: Lattice, distribution: Distribution = "tributary", cells: CellSection | None = None
) -> np.ndarray:
    """Return the mass of every lumped mass, (n,) [kg], with its part of the payloads (`lumped.payloads`); see
    `sheet_masses`."""
    return sheet_masses(scene, lattice, distribution, cells) + point_masses(scene, lattice)


def over_tributary(
    scene: Scene, lattice: Lattice, distribution: Distribution, cells: CellSection | None
) -> np.ndarray:
    """Return the ratio of each mass to its tributary mass, (n,), 0 off the sheet. Area forces times this
    ratio accelerate a flat sheet uniformly."""
    mass, tributary = (sheet_masses(scene, lattice, by, cells) for by in (distribution, "tributary"))
    return np.divide(mass, tributary, out=np.zeros_like(mass), where=tributary > 0.0)


def sheet_masses(
    scene: Scene, lattice: Lattice, distribution: Distribution = "tributary", cells: CellSection | None = None
) -> np.ndarray:
    """Return the sheet's part of every lumped mass, (n,) [kg]; the sum is the sheet's mass. cells: sections
    of cells that differ; each corner has a quarter of a cell's mass.

    Raises BadInput for an unknown distribution.
    """
    if distribution not in ("tributary", "gregory"):
        raise BadInput(f"masses = {distribution!r}: choose from tributary, gregory")
    (nx, ny, layers), (lx, ly, _) = lattice.grid, lattice.spacing
    if cells is None:
        mass = scene.material.density * scene.sheet.thickness / layers * lx * ly * lattice.share
        if distribution == "tributary":
            return mass
        plan = mass[::layers].reshape(ny, nx)
    else:
        quarter = 0.25 * cells.per_area * lattice.cell_areas / layers
        plan = np.asarray(sum(np.pad(quarter, ((1 - j, j), (1 - i, i))) for j in range(2) for i in range(2)))
    for axis, lines in enumerate(lattice.lines) if distribution == "gregory" else ():
        left, right, corrections = _corrections(lines)
        wider = np.where(right >= left, 1, -1)  # from the neighbour over the wider of its cells
        by_line = np.moveaxis(plan, 1 - axis, 0)
        shifted = (corrections * wider / np.maximum(left, right) / lines.tributary)[:, None] * by_line
        by_line += shifted
        np.subtract.at(by_line, np.arange(len(left)) + wider, shifted)
    if not scene.layers:
        return np.repeat(plan.ravel(), layers)
    return np.outer(layers * plan, shares_of_layers(scene, lattice)).ravel()


def shares_of_layers(scene: Scene, lattice: Lattice) -> np.ndarray:
    """Return the shares (layers,) of a column's mass that give it the laminate's centre of mass. Raises
    BadInput where a share would not be positive."""
    of, heights = of_sheet(scene), lattice.positions[: lattice.grid[2], 2]
    centre = of.moment_per_area / of.per_area
    shares = 1.0 / len(heights) + centre * heights / (heights @ heights)
    if shares.min() <= 0.0:
        raise BadInput(
            f"layer: the centre of mass is {1e3 * abs(centre):.3g} mm from the middle, beyond the layers "
            f"at {1e3 * heights.max():.3g} mm; choose the shell"
        )
    return np.asarray(shares)


def mass_matrix(
    scene: Scene, lattice: Lattice, distribution: Inertia, cells: CellSection | None = None
) -> sp.coo_array:
    """Return the mass matrix (n, n) [kg] of a component, x, y or z; its entries add up to the mass of the
    sheet and of its payloads. Raises BadInput as `masses`."""
    if distribution != "higher-order" or cells is not None:
        lumped = masses(scene, lattice, distribution, cells)  # type: ignore[arg-type]  # refuses higher-order
        return sp.dia_array((lumped[None], [0]), shape=2 * (lattice.mass_count,)).tocoo()
    twisting, free = lattice.twisting, _free_edges(scene, lattice)
    x, y = (_line_matrix(at, axis, twisting, free) for axis, at in zip("xy", lattice.lines, strict=True))
    per_area = scene.material.density * scene.sheet.thickness
    sheet = per_area * sp.kron(sp.kron(y, x), _layer_shares(scene.sheet.thickness, lattice))
    payloads = point_masses(scene, lattice)
    return sp.coo_array(sheet + sp.dia_array((payloads[None], [0]), shape=sheet.shape))


def _layer_shares(thickness: float, lattice: Lattice) -> np.ndarray:
    """Return the shares of a column's mass of pairs of layers, (layers, layers)."""
    layers = lattice.grid[2]
    heights = lattice.positions[:layers, 2]
    square = float(heights @ heights)
    rotary = 1.0 / layers - thickness**2 / (12.0 * square)
    return np.eye(layers) / layers - rotary * np.outer(heights, heights) / square


def _free_edges(scene: Scene, lattice: Lattice) -> frozenset[str]:
    """Return the edges that move and turn: nothing holds their director, nor their height."""
    return lattice.twisting - {support.edge for support in scene.supports if 2 in held_axes(support)}


def _line_matrix(lines: Lines, axis: str, twisting: frozenset[str], free: frozenset[str]) -> sp.csr_array:
    """Return the matrix (n, n) [m] of the corrected trapezoidal rule over the lines across an axis."""
    left, right, correction = _corrections(lines)
    correction[[0, -1]] *= [f"{axis}0" in twisting, f"{axis}1" in twisting]
    row, slopes = np.arange(len(left)), np.zeros((len(left), len(left)))
    slopes[row, row + (right > 0.0)] += correction / (left + right)
    slopes[row, row - (left > 0.0)] -= correction / (left + right)
    if len(left) > 2:
        for end, inner in ((0, 1), (-1, -2)):
            if f"{axis}{-end}" in free:
                slopes[inner] -= _end_curvature(lines, end)
    return sp.csr_array(np.diag(lines.tributary) - slopes - slopes.T)


def _corrections(lines: Lines) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the widths [m] of the cells before and after every line, 0 beyond the ends, and c [m²], (n,)
    each."""
    left, right = np.concatenate([[0.0], lines.widths]), np.concatenate([lines.widths, [0.0]])
    return left, right, (left**2 - right**2) / 12.0


def _end_curvature(lines: Lines, end: int) -> np.ndarray:
    """Return the second difference quotient at the first inner line of an end times l³/24, or l b²/24 where
    the second cell is narrower, b, (n,) [m]."""
    first, second = lines.widths[[0, 1] if end == 0 else [-1, -2]]
    quotient = np.array([1.0 / first, -1.0 / first - 1.0 / second, 1.0 / second])
    row = np.zeros(len(lines.at))
    row[:3] = first * min(first, second) ** 2 / 12.0 / (first + second) * quotient
    return row if end == 0 else row[::-1]
