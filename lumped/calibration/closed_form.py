"""Springs that meet D, A and the shear stiffness S* of the grid all at once, in closed form.

Square cells of side l, two layers at distance lz (docs/theory.md, section 3; S* is MacNeal's):

    lz² = [4 D + (2/3) S* l²/(1 − ν)]/A,  kd = D (1 − ν)/lz²,  ka = 2 kd,  kA = D (3ν − 1)/lz²,
    p = S* l²/(3 lz²),  kdT = p (l² + lz²)/l²,  kddT = p (2 l² + lz²)/(4 l²),
    m = ν A − 2 (kd + kA) − (p − δ),      kz = 8 D/lz² (free: it sets only δ and the stiffest frequency).

The module generalises them to cells of sides lx, ly (r = lx/ly) and L layers. The cross-layer links between
two layers have the in-plane form G11 = S*x lx²/(s lz²), G22 = S*y ly²/(s lz²), G12 = G66 = P for any split, s
the shear gaps of `lumped.moduli`; a share d of it at most goes to the furthest diagonals, d = ⅓ by default.
For σ = Σ z_k²/lz² and σ' = Σ z_g²/lz² of layers and gaps, a layer's form is

    C = (D − σ' lz² (G − δ))/(σ lz²).

Diagonals carry the share f = min(1, (C11 − C12)/2C66(r² − 1)) of C66, 1/(r² − 1) if C is isotropic (r ≥ 1;
with C22 for r < 1; more would need negative links along the cell, see `lumped.springs.laws`), shear springs
the rest, area springs C12 − f C66, axial links the rest of C11 and C22. The difference of the sheet's A and
L C + (L − 1)(G − δ) goes to the mid-surface: m to A12, the rest to strain springs, with lz the least for
which none is negative. On square cells the strain springs vanish if P is G11/3. All cells of a graded grid
have one layer distance: lz is then given, and larger than most cells need.

If S* couples shear along x with shear along y, an upright face over one diagonal of a cell has S*xy, and
|S*xy| r of S*x, |S*xy|/r of S*y, each at most COUPLED of them; the links have the rest.

The layers of a sheet with B differ, C + z_k C' with C' = B/Σ z_k²: the lowest and the highest have the
springs of C + z_k C', links a third of E h as at an angle to fibres, and layers between grow `upward`. The
layers must be close enough for the softest to resist any strain; so upright faces alone carry S*, a share d
of it over the cells' diagonals, and lz is the least that A and D allow.

The choice of lz affects the energy of a strain that varies across a cell. A cell bent in its plane, ε_x = χ
y, has the links along x on its two sides stretched and nothing else: with E_x of A11 in the links it stores ½
E_x (χ ly/2)² per area, whereas the sheet, free to contract, stores ½ (A11 − A12²/A22) χ² ly²/12. So links
along the sides should carry E_x = (A11 − A12²/A22)/3, a third of an isotropic sheet's E h, and springs of the
whole cell the rest. At the least lz they carry up to three times as much, so that a coarse lattice is too
stiff in its plane, and layers at bent edges and in soft sheets too wide. At a larger distance softer layers
give D and S as well: the sides carry a third (`gradients`) from

    lz² = [L (C11 − C12 + (1 − r²) f C66) + (L − 1)(G11 − P r²)] lz²/E_x

on, and by the formula for y; the mid-surface has the rest. A long cell (l ≫ h) bent by θ is too soft by

    θ²/12 − w θ²/8 + (1 − w)² θ²/(k + 40 w/3),    w = S* lz²/8D,    k = kz lz²/D,

by the chord in place of an arc, the diagonals that shorten as it bends, and the columns that shorten
(docs/theory.md, 3). For k = 8 the last part exceeds the chord's, so sheets with `gradients`, which may bend
far, have stiffer columns: k = 8 COLUMN_FACTOR.

The diagonals' share d is free too. For a wave of wave number q at the angle θ to the grid the stiffness of
square cells is too small by (q l)² sin² 2θ/48 times

    5 + 3ν − (21 d − 9 d²)/(1 + t) − 12 d t/(1 + t),    1 + t = 12 D/(S* l²),

which is 3ν − 1 + 2 S*/κGh for a third and vanishes (`waves`) for a d from 0.27 to 0.54, ν from 0 to ½.
"""

from typing import Any

import numpy as np

from lumped.calibration.cell_by_cell import GridCells
from lumped.moduli import Moduli, second_moment, shear_gaps
from lumped.spring_constants import UPWARD, Springs, by_direction

COLUMN_FACTOR = 4.0  # with `gradients`; the explicit step of cells of 5 h or more does not suffer
SOFTEST = 1e-6  # least eigenvalue of a layer's form, relative to the mean layer's stiffness along x
COUPLED = 0.9  # largest share of the shear stiffness along a side in faces over diagonals
COUPLED_STRAINS = ("coupling_xy", 0, 1), ("coupling_x", 0, 2), ("coupling_y", 1, 2)
Split = tuple[np.ndarray, np.ndarray, np.ndarray]
PAIRS = ("axial", "cross", "stretch", "mid_stretch", "face_shear")  # constants with values along x and y


class NoClosedForm(Exception):
    """Report a cell, of the sides [m] in `args`, without nonnegative springs in closed form."""


def springs_of_cells(
    grid_cells: GridCells, layer_distance: float | None = None, allow_negative: bool = False, **special: bool
) -> Springs:
    """Return the springs of all cells, at the largest layer distance that a cell of the sheet needs. Raises
    NoClosedForm for a cell without a closed form, unless `allow_negative`: some springs are then negative."""
    (sides, _), target, layers = grid_cells.present, grid_cells.target, grid_cells.grid[2]
    constants, distance, exists = closed_form(target, sides, layers, layer_distance, **special)
    one_sheet = not grid_cells.several
    if layer_distance is None and one_sheet and len(sides) > 1 and exists.all():
        constants, distance, exists = closed_form(target, sides, layers, float(distance.max()), **special)
    if not (allow_negative or exists.all()):
        raise NoClosedForm(*sides[np.argmin(exists)])
    of = {name: grid_cells.on_grid(values) for name, values in constants.items()}
    return Springs.made(
        float(distance.max()) if one_sheet else grid_cells.on_grid(distance),
        **{name: by_direction(*v) if name in PAIRS and not allow_negative else v for name, v in of.items()},
    )


def closed_form(
    target: Moduli,
    sides: np.ndarray,
    layers: int,
    layer_distance: float | None = None,
    gradients: bool = False,
    waves: bool = False,
) -> tuple[dict[str, np.ndarray], np.ndarray, np.ndarray]:
    """Return the springs of cells with sides (m, 2) [m] for target moduli (m, …): constants [N/m] by name,
    (m,), or (2, m) along x and y, the layer distances (m,) [m], and whether each cell has a closed form,
    (m,). A cell has none if a link would be negative (many layers on coarse grids: there the cross-layer
    links alone bend too stiffly), or if a given layer distance [m] is less than the cell needs. gradients:
    whether the layer distance gives in-plane strains that vary across a cell the sheet's energy; waves:
    whether oblique waves of bending are right in l², in oblong cells as in squares of their area."""
    lx, ly = sides.T
    sigma, sigma_gap = second_moment(layers), second_moment(layers - 1)
    squares, membrane, bending = sides**2, target.membrane, target.bending
    ratios = squares / squares[:, ::-1]
    most = COUPLED * (target.shear / np.sqrt(ratios)).min(axis=1)
    coupling = np.clip(target.coupling, -most, most)
    uncoupled_shear = target.shear - np.abs(coupling)[:, None] * np.sqrt(ratios)
    gap = uncoupled_shear * squares / shear_gaps(layers)  # G11 lz², G22 lz² [N·m]
    unequal_layers = bool(target.mixed.any())
    coupled = target.oblique | unequal_layers
    upright = (COLUMN_FACTOR if gradients else 1.0) * vertical(target, sides, 1.0)  # kz lz² [N·m]
    bracket = 5.0 + 3.0 * bending[:, 0, 1] / bending[:, 0, 0]
    share = diagonals_for_waves(target, lx * ly, bracket) if waves else 1.0 / 3.0
    least = np.minimum(bending[:, 0, 0], bending[:, 1, 1])
    share = share * np.minimum(1.0, 4.0 * bending[:, 2, 2] / least)  # less in sheets that are soft in shear
    faces, over = np.zeros_like(gap), np.zeros_like(lx)
    if unequal_layers:
        over = 0.5 * share * (gap / squares**2).min(axis=1) * squares.sum(axis=1)
        faces = gap / squares - 2.0 * over[:, None] * squares / squares.sum(axis=1, keepdims=True)
        gap = np.zeros_like(gap)
    p = share * np.minimum(gap.max(axis=1), (1.5 * gap / ratios).min(axis=1))
    gap_form = np.zeros_like(bending)
    gap_form[:, 0, 0], gap_form[:, 1, 1] = gap.T
    gap_form[:, 0, 1] = gap_form[:, 1, 0] = gap_form[:, 2, 2] = p
    along = gap - p[:, None] * ratios

    anisotropic = _anisotropic(bending)

    distance_given = layer_distance is not None
    lz2 = np.full(len(p), layer_distance**2 if layer_distance is not None else 0.0)
    iterating = np.ones(len(p), dtype=bool)
    for _ in range(50):  # δ is small and depends little on lz: a fixed point
        relaxed = gap_form - _relaxation(gap, along, p, sides, lz2, upright)
        layer = (bending - sigma_gap * relaxed) / sigma
        lattice = layers * layer + (layers - 1) * relaxed
        of_mean = _, axial, fibres = _split(layer, ratios, coupled, anisotropic)
        normal = _normal(lattice) - lattice[:, 0, 1, None]
        needed = normal / (_normal(membrane) - membrane[:, 0, 1, None])
        needed = np.maximum(needed.max(axis=1), lattice[:, 2, 2] / membrane[:, 2, 2])
        if fibres.any():
            needed[fibres] = _largest_eigenvalue(lattice[fibres], membrane[fibres])
        if gradients:
            on_sides = layers * axial + (layers - 1) * along
            needed = np.maximum(needed, (on_sides / _on_sides(membrane)).max(axis=1))
        if distance_given:
            break
        iterating &= (needed > 0.0) & ~(np.abs(needed - lz2) < 1e-15 * needed)
        if not iterating.any():
            break
        lz2 = np.where(iterating, needed, lz2)
    exists = (lz2 > 0.0) & (layer[:, 2, 2] > 0.0) & (axial.min(axis=1) >= 0.0)
    if distance_given:
        exists &= needed <= lz2 * (1.0 + 1e-9)
    if fibres.any():
        exists[fibres] &= np.linalg.eigvalsh(layer[fibres])[:, 0] > 0.0
    of: dict[str, Any] = {}
    if unequal_layers:
        outer = 0.5 * (layers - 1) * target.mixed * np.sqrt(lz2)[:, None, None] / sigma
        forms = layer - outer, layer + outer  # the lowest layer and the highest
        splits = [_split(form, ratios, coupled, _anisotropic(form)) for form in forms]
        for form, (_, along_sides, _) in zip(forms, splits, strict=True):
            exists &= np.linalg.eigvalsh(form)[:, 0] > SOFTEST * layer[:, 0, 0]
            exists &= along_sides.min(axis=1) >= 0.0
        low, high = (_of_layer(form, split, sides) for form, split in zip(forms, splits, strict=True))
        for name in low.keys() & high.keys():
            of[name] = 0.5 * (low[name] + high[name])
            rise = np.reshape((high[name] - low[name]) / (layers - 1), (-1, len(lx)))
            of |= dict(zip(UPWARD[name], rise, strict=True))
        of |= {"face_shear": faces.T * lz2, "face_diagonal_shear": over * lz2}
    else:
        of = _of_layer(layer, of_mean, sides)
    lz2 = np.where(exists, lz2, 1.0 if not distance_given else lz2)
    middle = membrane * lz2[:, None, None] - lattice
    mid_area = np.where(fibres, 0.0, middle[:, 0, 1])
    of |= {f"mid_{name}": np.where(fibres, middle[:, i, j], 0.0) for name, i, j in COUPLED_STRAINS}
    middle[:, :2, :2] -= mid_area[:, None, None]
    middle[np.abs(middle) < 1e-12 * (membrane[:, 0, 0] * lz2)[:, None, None]] = 0.0
    across = np.sqrt(squares[:, ::-1] / squares).T
    of |= {
        "face_coupling": coupling * squares.sum(axis=1) / (lx * ly * shear_gaps(layers)) * lz2,
        "vertical": upright,
        "cross": along.T * (squares.T + lz2) * across / (2.0 * squares.T),
        "cross_diagonal": p * (lx**2 + ly**2 + lz2) / (4.0 * lx * ly),
        "mid_area": mid_area,
        "mid_shear": middle[:, 2, 2],
        "mid_stretch": _normal(middle).T,
    }
    return {name: values / lz2 for name, values in of.items()}, np.sqrt(lz2), exists


def _anisotropic(form: np.ndarray) -> np.ndarray:
    """Return whether forms (m, 3, 3) are anisotropic, C11 − C12 ≠ 2 C66, (m,)."""
    stretching, shearing = form[:, 0, 0] - form[:, 0, 1], 2.0 * form[:, 2, 2]
    return np.asarray(np.abs(stretching - shearing) > 1e-9 * np.maximum(np.abs(stretching), np.abs(shearing)))


def _split(layer: np.ndarray, ratios: np.ndarray, oblique: np.ndarray, anisotropic: np.ndarray) -> Split:
    """Return the share f of C66 of layers (m, 3, 3) in diagonals (m,), half of the share at which axial
    links vanish, the parts of C11 and C22 in axial links (m, 2), and whether cells need couplings (m,).

    Cells at an angle to the fibres (`oblique`) need them, and cells of an `anisotropic` sheet whose area
    springs would leave the links along the sides less than a third of E h (`gradients`). Axial links beside
    couplings have a third of E h."""
    limit = 0.5 * np.maximum(_normal(layer) - layer[:, 0, 1, None], 0.0)
    target = layer[:, 2, 2, None] * (ratios - 1.0)
    shares = np.divide(limit, target, out=np.ones_like(limit), where=target > limit)
    by_diagonals = np.minimum(1.0, shares.min(axis=1))
    axial = _normal(layer) - (layer[:, 0, 1] - by_diagonals * layer[:, 2, 2] * (1.0 - ratios).T).T
    candidate = oblique | anisotropic
    if not candidate.any():
        return by_diagonals, axial, candidate
    candidate &= oblique | (np.linalg.eigvalsh(layer)[:, 0] > 0.0)
    third = np.zeros_like(axial)
    third[candidate] = 1.0 / (3.0 * _normal(np.linalg.inv(layer[candidate])))
    fibres = candidate & (oblique | (axial < third).any(axis=1))
    by_diagonals[fibres] = 0.0
    return by_diagonals, np.where(fibres[:, None], third, axial), fibres


def _of_layer(layer: np.ndarray, split: Split, sides: np.ndarray) -> dict[str, np.ndarray]:
    """Return the springs of layers (m, 3, 3) by name, (m,) or (2, m)."""
    (by_diagonals, axial, fibres), (lx, ly) = split, sides.T
    couplings = {name: np.where(fibres, layer[:, row, column], 0.0) for name, row, column in COUPLED_STRAINS}
    return couplings | {
        "axial": axial.T * np.stack([ly / lx, lx / ly]),
        "diagonal": by_diagonals * layer[:, 2, 2] * (lx**2 + ly**2) / (2.0 * lx * ly),
        "area": np.where(fibres, 0.0, layer[:, 0, 1] - by_diagonals * layer[:, 2, 2]),
        "stretch": np.where(fibres, (_normal(layer) - axial).T, 0.0),
        "shear": (1.0 - by_diagonals) * layer[:, 2, 2],
    }


def _normal(form: np.ndarray) -> np.ndarray:
    """Return the entries 11 and 22 of forms, (m, 2)."""
    return np.diagonal(form, axis1=1, axis2=2)[:, :2]


def _largest_eigenvalue(form: np.ndarray, by: np.ndarray) -> np.ndarray:
    """Return the largest eigenvalue of forms relative to others, (m,)."""
    inverse = np.linalg.inv(np.linalg.cholesky(by))
    return np.asarray(np.linalg.eigvalsh(inverse @ form @ np.swapaxes(inverse, 1, 2))[:, -1])


def diagonals_for_waves(target: Moduli, area: np.ndarray, bracket: np.ndarray) -> np.ndarray:
    """Return the diagonals' share d of the shear (m,) that makes oblique waves right in l². area: (m,) [m²]
    of the cells; bracket: (m,) the factor of the error for d = 0, 5 + 3 ν for links."""
    rigidity = target.bending[:, 0, 0]
    stiffening = 12.0 * rigidity / (np.sqrt(target.shear.prod(axis=1)) * area)  # 1 + t
    linear = 12.0 * stiffening + 9.0
    product = 36.0 * bracket * stiffening
    return np.asarray((linear - np.sqrt(linear**2 - product)) / 18.0)


def _on_sides(form: np.ndarray) -> np.ndarray:
    """Return the parts of a form's 11 and 22 that the links on a cell's sides should carry, (m, 2)."""
    normal = _normal(form)
    return np.asarray((normal - form[:, 0, 1, None] ** 2 / normal[:, ::-1]) / 3.0)


def vertical(target: Moduli, sides: np.ndarray, lz2: float) -> np.ndarray:
    """Return kz (m,) [N/m]: 8 D/lz² per square of the shorter spacing, over the cell; D² = D11 D22."""
    squares = sides.prod(axis=1) / sides.min(axis=1) ** 2
    return np.asarray(8.0 * np.sqrt(target.bending[:, 0, 0] * target.bending[:, 1, 1]) / lz2 * squares)


def _relaxation(
    gap: np.ndarray, along: np.ndarray, p: np.ndarray, sides: np.ndarray, lz2: np.ndarray, upright: np.ndarray
) -> np.ndarray:
    """Return δ lz² (m, 3, 3), the reduction of a gap's in-plane form because its thickness is free to change;
    along: (m, 2) the cross links' part of the form; upright: kz lz² [N·m]."""
    area = sides.prod(axis=1)
    coupling = gap / sides**2  # the gap's S along x, y [N/m]
    thickness = upright / area + ((along / sides**4).sum(axis=1) + p / area**2) * lz2
    relaxation = np.zeros((len(p), 3, 3))
    relaxation[:, :2, :2] = coupling[:, :, None] * coupling[:, None] * (lz2 / thickness)[:, None, None]
    return relaxation
