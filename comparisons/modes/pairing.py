"""Pairing of two models' modes by shape, and the kinds of a flat sheet's modes.

The modal assurance criterion of shapes a and b is MAC = (a·Mb)² / ((a·Ma)(b·Mb)): 1 for equal shapes, 0 for
shapes orthogonal in the mass M. Shapes are sampled at the centres of equal plan cells, where M by the
midpoint rule is a factor that cancels. The pairing is the assignment with the largest sum of MAC (Kuhn and
Munkres; Allemang, Sound and Vibration 37, 2003, for the criterion). Modes of equal frequency are defined up
to a rotation among each other: an orthogonal Procrustes rotates the second model's modes to the first's.

Kinds are bending, twist, bending across, in plane. A mode is in plane if most of the mass-weighted square of
its displacement is along the sheet. The deflection w(x, y) of any other mode is split by its singular values,
w ≈ σ f(along) g(across): a g without a change of sign is bending, with one change twist, with more bending
across (chordwise). The axis runs from the supports to the free edge, along the longer side of a free sheet,
and between two supported edges; a sheet held at adjacent edges has no axis, and all its modes out of plane
count as bending.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from comparisons.pictures.plan import inside
from sheetbench.scenes import Scene, Sheet
from sheetbench.scenes.objects.grid import near_square
from sheetbench.scenes.objects.supports import place

ModeSet = tuple[str, np.ndarray, np.ndarray]  # a model, its frequencies or load factors, rising, and shapes
CELLS = 32  # plan cells along the shorter side; the tenth mode has some five half-waves
REPEATED = 1e-6  # relative difference below which frequencies count as equal: above the eigensolvers' error
LEAST = 0.5  # MAC from which two shapes count as one mode


@dataclass(frozen=True)
class Pair:
    """Mode `number` of model `of`, from 1, and the mode of model `against` with an equal shape. is_: the
    latter's number, None without a counterpart; mac: of both shapes; relative: difference of frequency or
    load factor over the reference's; kind: of the shape, None about a deformed sheet."""

    of: str
    number: int
    against: str
    is_: int | None
    mac: float
    relative: float | None
    kind: str | None

    @property
    def swapped(self) -> bool:
        """Whether the mode has another number in the reference's list."""
        return self.is_ not in (None, self.number)

    def as_dict(self) -> dict[str, Any]:
        """Return the pair as JSON data."""
        return {key.rstrip("_"): value for key, value in asdict(self).items()}


def pairs_of(first: ModeSet, others: Sequence[ModeSet], kinds: Sequence[str | None]) -> tuple[Pair, ...]:
    """Pair every mode of the first model with each other model's; kinds: of the first's modes."""
    pairs, (of, first_values, first_shapes) = [], first
    for model, values, shapes in others:
        mac = assurance(first_shapes, shapes, values)
        for i, match in enumerate(matched(mac)):
            at = int(np.argmax(mac[i])) if match is None else match
            relative = None if match is None else float(first_values[i] / values[at] - 1.0)
            is_ = None if match is None else match + 1
            pairs.append(Pair(of, i + 1, model, is_, float(mac[i, at]), relative, kinds[i]))
    return tuple(pairs)


def cell_centres(sheet: Sheet) -> np.ndarray:
    """Return the centres (n, 2) [m] of equal, near-square plan cells; y runs fastest."""
    axes = [
        (np.arange(count) + 0.5) * length / count
        for count, length in zip(near_square(sheet, CELLS), sheet.lengths, strict=True)
    ]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)


def on_cells(scene: Scene, shapes: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Sample shapes, a function of plan points, at `cell_centres`: (count, n, 3), zero off the sheet."""
    plan = cell_centres(scene.sheet)
    on_sheet = inside(scene, plan)
    values = shapes(plan[on_sheet])
    out = np.zeros((len(values), len(plan), 3))
    out[:, on_sheet] = values
    return out


def assurance(shapes: np.ndarray, others: np.ndarray, frequencies: np.ndarray) -> np.ndarray:
    """Return the MAC (m, k) of shapes (m, n, 3) and others (k, n, 3) sampled on equal cells; frequencies
    (k,): of the others."""
    first, second = _normalised(shapes), _normalised(others)
    for group in _repeated(frequencies):
        projected = first @ second[group].T  # every first shape onto the group
        nearest = np.argsort(-np.sum(projected**2, axis=1))[: len(group)]
        left, _, right = np.linalg.svd(projected[nearest], full_matrices=False)
        second[group[: len(nearest)]] = left @ right @ second[group]
    return np.asarray((first @ second.T) ** 2)


def matched(mac: np.ndarray) -> list[int | None]:
    """Return the column assigned to every row, None for a MAC below `LEAST`."""
    rows, columns = linear_sum_assignment(mac, maximize=True)
    out: list[int | None] = [None] * len(mac)
    for row, column in zip(rows, columns, strict=True):
        if mac[row, column] >= LEAST:
            out[row] = int(column)
    return out


def _normalised(shapes: np.ndarray) -> np.ndarray:
    flat = shapes.reshape(len(shapes), -1)
    return np.asarray(flat / np.linalg.norm(flat, axis=1, keepdims=True))


def _repeated(frequencies: Sequence[float] | np.ndarray) -> Iterator[np.ndarray]:
    """Yield the indices of each group of equal frequencies, ascending."""
    breaks = np.flatnonzero(np.diff(frequencies) > REPEATED * np.asarray(frequencies)[1:]) + 1
    for group in np.split(np.arange(len(frequencies)), breaks):
        if len(group) > 1:
            yield group


BENDING, TWIST, ACROSS, IN_PLANE = "bending", "twist", "bending across", "in plane"
STILL = 0.05  # of the largest |g|: a change of sign below it comes from the discretisation


def kinds(scene: Scene, shapes: np.ndarray, cells: int) -> list[str]:
    """Return the kind of every shape (m, n, 3), sampled at `cell_centres` with `cells` along the shorter
    side; bending is numbered from 1, other kinds from their second mode."""
    axis, names = _axis(scene), list[str]()
    counts = Counter[str]()
    for shape in shapes:
        kind = _kind(shape.reshape(*near_square(scene.sheet, cells), 3), axis)
        counts[kind] += 1
        names.append(kind if kind != BENDING and counts[kind] == 1 else f"{kind} {counts[kind]}")
    return names


def _kind(shape: np.ndarray, axis: int | None) -> str:
    """Return the kind of a shape (nx, ny, 3); axis: 0 for x, 1 for y, None."""
    along, deflection = np.sum(shape[..., :2] ** 2), shape[..., 2]
    if along > np.sum(deflection**2):
        return IN_PLANE
    if axis is None:
        return BENDING
    _, _, across = np.linalg.svd(deflection if axis == 0 else deflection.T, full_matrices=False)
    moving = across[0][np.abs(across[0]) > STILL * np.abs(across[0]).max()]
    changes = int(np.count_nonzero(np.diff(np.sign(moving))))
    return (BENDING, TWIST, ACROSS)[min(changes, 2)]


def _axis(scene: Scene) -> int | None:
    held = {"xy".index(support.edge[0]) for support in scene.supports if place(support) is None}
    if len(held) == 1:
        return held.pop()
    return None if held else int(np.argmax(scene.sheet.lengths))
