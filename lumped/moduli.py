"""Homogenisation: the plate moduli of a lattice, from the energy of its unit cell in closed form.

A link of rest vector d (length L) and stiffness k stores ½ k (d·E d / L)². E has the in-plane strain
(ε_x, ε_y, γ_xy) at the link's mid-height, the stretch of its gap ε_z and the transverse shears γ_x, γ_y:

    d·E d = dx² ε_x + dy² ε_y + dx dy γ_xy + dz² ε_z + dx dz γ_x + dy dz γ_y.

Summed over a cell of area lx ly this gives a 6×6 form per layer (dz = 0, with the area spring) and per
gap between layers. Layers at z_k and gaps at z_g add up, with ε_z of each gap relaxed, to

    A = Σ_k C + Σ_g G + m 1 1ᵀ,     D = Σ_k z_k² C + Σ_g z_g² G,     S = Σ s_g  (see below),

and of layers C + z_k C' B = Σ_k z_k² C', where C is a layer's 3×3 form and G a gap's after relaxation. Under
a transverse force the gaps carry shear in proportion to t_g = Σ_{k above g} z_k (equilibrium of the layers),
so that the shear stiffness is (Σ t_g)²/Σ t_g² times one gap's: 1 for two layers, 2 for three.

The sheet itself has D_ij and A_ij of an isotropic plane-stress plate and, on a grid of spacing l,
MacNeal's (1978) residual-bending shear stiffness 1/S* = 1/(κ G h) + l²/(12 D), κ = 5/6, which makes the
one-point sheared lattice exact for cubic deflections; of unlike layers D − B A⁻¹ B is in place of D.
Stiffness per length: A, S [N/m], B [N], D [N·m].
"""

from collections import Counter
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lumped.lattice import STEPS
from lumped.sections import ROUNDING, CellSection, free, free_bending
from lumped.spring_constants import FACES, Springs, of_faces, of_rubber
from sheetbench.scenes import SpringSet

# of the links of STEPS: family and direction, how many there are, and whether they span lx, ly and lz
LINKS = Counter((family, direction, tuple(map(abs, step))) for family, direction, step in STEPS)
COUNT, SPAN = np.array([*LINKS.values()], dtype=float), np.array([span for *_, span in LINKS], dtype=float)
LEVEL = int(np.sum(SPAN[:, 2] == 0.0))  # those within a layer, which come first


@dataclass(frozen=True)
class Moduli:
    """Moduli of plates: the in-plane forms A [N/m], D [N·m] and B [N], `mixed`, (…, 3, 3) over (x, y, xy);
    the shear stiffness S (…, 2) [N/m], and the coupling of shear along x with shear along y, (…). The dots
    are (cells,) or (rows, columns) of cells."""

    membrane: np.ndarray
    bending: np.ndarray
    shear: np.ndarray
    coupling: np.ndarray
    mixed: np.ndarray

    @property
    def oblique(self) -> np.ndarray:
        """Return whether stretching along the sides shears, (…): fibres are at an angle to them."""
        forms = self.membrane, self.bending, self.mixed
        skew = [np.abs(form[..., :2, 2]).max(axis=-1) > ROUNDING * np.abs(form[..., 0, 0]) for form in forms]
        return np.any(skew, axis=0)

    @property
    def free_bending(self) -> np.ndarray:
        """Return D − B A⁻¹ B."""
        return free_bending(self.membrane, self.mixed, self.bending)

    @property
    def free_shear(self) -> np.ndarray:
        """Return S along x and y (…, 2) where no force shears the other way."""
        return free(self.shear, self.coupling)

    def named(self, square: bool, oblique: bool = False, mixed: bool = False) -> dict[str, np.ndarray]:
        """Return the moduli by name, (…) each, one for x and y on square cells. mixed: whether with B."""
        a, d, s = self.membrane, self.bending, self.shear
        forms = {"D": d, "A": a} | ({"B": self.mixed} if mixed else {})
        places = {"11": (0, 0), "12": (0, 1), "66": (2, 2)}
        each = [(kind, form, *place) for kind, form in forms.items() for place in places.items()]
        names = {f"{kind}{ij}": form[..., i, j] for kind, form, ij, (i, j) in each}
        if oblique:
            names |= {f"{kind}{n + 1}6": form[..., n, 2] for kind, form in forms.items() for n in range(2)}
        if square:
            return {**names, "S": s[..., 0]}
        both = {"Sxy": self.coupling} if oblique else {}
        names |= {f"{kind}22": form[..., 1, 1] for kind, form in forms.items()}
        return {**names, "Sx": s[..., 0], "Sy": s[..., 1]} | both


def gap_shear_per_stiffness(sides: np.ndarray, distance: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the shear stiffness of one gap along x and y, per unit stiffness of the cross links that run so,
    (…, 2), and of the furthest diagonals, (…, 2) [1]; sides: of the cells, (…, 2) [m]."""
    squares, upright, area = sides**2, np.asarray(distance)[..., None] ** 2, sides.prod(axis=-1)[..., None]
    sheared = 2.0 * squares * upright / area
    return sheared / (squares + upright), 2.0 * sheared / (squares.sum(axis=-1)[..., None] + upright)


def shear_gaps(layers: int) -> float:
    """Return (Σ t_g)²/Σ t_g², t_g = g (L − g)/2: the sheet's shear stiffness in units of one gap's."""
    return 5 * layers * (layers**2 - 1) / (6 * (layers**2 + 1))


def second_moment(layers: int) -> float:
    """Return Σ z_k² about the middle of L layers at unit distance, or of L gaps between L + 1 layers."""
    return layers * (layers**2 - 1) / 12


def of_cells(springs: Springs, sides: np.ndarray, layers: int) -> Moduli:
    """Return the moduli of interior patches of lattices, each with the springs of one cell throughout; sides:
    of the cells, (rows, columns, 2) [m], or of one where they are alike."""
    shape = np.broadcast_shapes(sides.shape[:2], springs.shape)
    distance = np.asarray(springs.layer_distance)[..., None]
    square = distance**2
    squares = np.empty((*shape, len(LINKS), 3))  # of the lengths that links span
    squares[..., :2], squares[..., 2] = SPAN[:, :2] * sides[..., None, :] ** 2, SPAN[:, 2] * square
    stiffness = np.zeros(squares.shape[:-1])
    for number, (family, direction, _) in enumerate(LINKS):
        if len(k := springs[family]) == 3:  # Habibi et al.'s law has no energy: its mean
            stiffness[..., number] = k.mean(axis=0)
        elif family in springs.of:
            stiffness[..., number] = springs.along(family, int(direction == "y"))
    stiffness *= COUNT / (squares.sum(axis=-1) * sides.prod(axis=-1)[..., None])
    turned = np.swapaxes(squares * stiffness[..., None], -1, -2)
    # over the strains along x, y and z; those of shears are its products
    layer, gap = (turned[..., of] @ squares[..., of, :] for of in (slice(LEVEL), slice(LEVEL, None)))
    in_layer = _of_links(layer) + _in_plane(springs, "area")
    if springs.rubber:
        cell_sides = np.broadcast_to(sides, (*shape, 2)).reshape(-1, 2)
        shapes = cell_sides**2, cell_sides.prod(axis=1), np.zeros(len(cell_sides))
        strains, _ = of_rubber(springs, *shapes, lambda values: np.broadcast_to(values, shape).ravel())
        in_layer += _form(strains[:, 1:].reshape(*shape, 3), strains[:, 0].reshape(shape))
    upright = gap[..., 2, 2, None, None]
    in_gap = _of_links(gap)
    relaxed = gap[..., :2, 2, None] * gap[..., None, 2, :2]
    in_gap[..., :2, :2] -= np.divide(relaxed, upright, out=np.zeros_like(relaxed), where=upright > 0.0)
    shear = gap[..., :2, 2]
    if springs.of.keys() & FACES:
        shear = shear + sum(of_faces(springs, sides**2))
    more = springs.upward
    upward = of_cells(more, sides, layers).membrane if more.of else np.zeros_like(in_layer)
    coupling = springs.along("face_coupling", 0) * sides.prod(axis=-1) / np.sum(sides**2, axis=-1)
    return Moduli(
        membrane=layers * in_layer + (layers - 1) * in_gap + _in_plane(springs, "mid_area"),
        bending=(second_moment(layers) * in_layer + second_moment(layers - 1) * in_gap) * square[..., None],
        shear=shear_gaps(layers) * shear,
        coupling=shear_gaps(layers) * np.broadcast_to(coupling, shape),
        mixed=second_moment(layers) * distance[..., None] / layers * upward,
    )


def of_springs(springs: SpringSet, spacing: tuple[float, float, float], layers: int) -> Moduli:
    """Return the moduli of an interior patch of a lattice with equal springs in all cells."""
    read = replace(Springs.read(springs), layer_distance=spacing[2])
    of_cell = of_cells(read, np.array([[spacing[:2]]]), layers)
    return Moduli(*(part[0, 0] for part in vars(of_cell).values()))


def _of_links(form: np.ndarray) -> np.ndarray:
    """Return the form (…, 3, 3) over (x, y, xy) of links from their form over (x, y, z)."""
    central = np.zeros_like(form)
    central[..., :2, :2], central[..., 2, 2] = form[..., :2, :2], form[..., 0, 1]
    return central


def _in_plane(springs: Springs, cells: str) -> np.ndarray:
    """Return the form (…, 3, 3) of area springs, strain springs and couplings."""
    strains = springs.strains(cells)
    form = _form(strains[..., :3], springs.along(cells, 0))
    for number, (row, column) in ((3, (0, 1)), (4, (0, 2)), (5, (1, 2))):
        form[..., row, column] += strains[..., number]
        form[..., column, row] = form[..., row, column]
    return form


def _form(diagonal: np.ndarray, area: np.ndarray) -> np.ndarray:
    """Return the form (…, 3, 3) of strain springs (…, 3) and area springs (…)."""
    form = np.zeros((*diagonal.shape, 3))
    form[..., :2, :2] = area[..., None, None]
    for number in range(3):
        form[..., number, number] += diagonal[..., number]
    return form


def of_section(section: CellSection, spacing: Any) -> Moduli:
    """Return the moduli of sections, with MacNeal's S* of the in-plane spacings (lx, ly) (…, 2) [m] as the
    shear stiffness."""
    bending = free_bending(section.membrane, section.mixed, section.bending)
    own = np.diagonal(bending, axis1=-2, axis2=-1)[..., :2]
    residual = (np.square(spacing) / (12.0 * own))[..., None] * np.eye(2)
    shear = np.linalg.inv(np.linalg.inv(section.shear) + residual)
    along = np.diagonal(shear, axis1=-2, axis2=-1)
    return Moduli(section.membrane, section.bending, along, shear[..., 0, 1], section.mixed)
