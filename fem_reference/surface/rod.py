"""Actuator as a continuous elastic rod along an edge: its strains, its stiffness and its weight.

The rod's axis r = φ + c d lies at a height c along the director d of the edge. Its cross-section is bound to
the edge: it turns with d and with a third director m, which points out of the sheet and is the rod's own.
Its energy, s being the arc length along the flat edge, is

    ½ EI ∫ (κ_n − κ₀)² ds,   κ_n = −r' · d'     bending in the plane of the edge and the normal
    ½ EI ∫ (κ_g − κ₀)² ds,   κ_g = −r' · m'     bending in the sheet's plane

A chain neither stretches, shears nor twists, and its joints turn about certain axes only; so the following
strains vanish, by stiffnesses `FIRM` times the sheet's and `SLENDER` times the rod's own:

    ½ (r' · r' − 1),   r' · d,   r' · m,   d · m,   d' · m,
    and κ_g in the plane "normal" (all m are then parallel), κ_n in the plane "inplane" (all d are).

"spatial" bends both ways and has its κ₀ in κ_n. The rod as a whole may turn about its own axis with the edge.
A list of curvatures is piecewise constant over the shares of the joints, the first and the last reaching to
the ends; a table counts with its last value. Chains on one edge act as one rod on the mean of their axes,
their EI summed, their weights at their own heights.

On a side of three nodes all strains are quadratic forms of Q = (φ₁ … φ₃, d₁ … d₃, m₁ … m₃), sampled at two
Gauss points (d · m at the nodes), where neither inextensibility nor the absence of shear locks. SI units.
Source: Antman, Nonlinear Problems of Elasticity (2005), ch. 8 (the special Cosserat rod).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from fem_reference.surface.biquadratic import TWO, lagrange, side_shape
from fem_reference.surface.loads import Line
from fem_reference.surface.mesh import Plan
from fem_reference.surface.supports import Supports
from sheetbench.errors import BadInput
from sheetbench.scenes import EDGES, Chain, Scene

FIRM, SLENDER = 1e3, 1e5  # firm stiffnesses over the sheet's and over the rod's own
STRAINS = 15
AXIAL, SHEAR, ASIDE, NORMAL, INPLANE, TWIST = (slice(2 * i, 2 * i + 2) for i in range(6))
SQUARE = slice(12, 15)

_VALUE, _SLOPE = side_shape(TWO)  # (2 points, 3 nodes)
_SHARES = np.array([1.0, 4.0, 1.0]) / 3.0  # ∫ N dξ
_SAMPLES = 400  # of a side, for the mean of a piecewise curvature


class RodElements(NamedTuple):
    """Sides with s strains of a vectors each, e = ½ Qᵀ H Q − ½ Q₀ᵀ H Q₀ (see `discrete.rods`). reference: Q₀
    (k, a, 3); forms: H (k, s, a, a); stiffness: S (k, s); intrinsic: e₀ (k, s, c) of the curvatures of all
    actuators."""

    reference: np.ndarray
    forms: np.ndarray
    stiffness: np.ndarray
    intrinsic: np.ndarray


@dataclass(frozen=True)
class Rod:
    """Rod along an edge of p nodes: its chains by name, and its k sides as elements. nodes: (k, 3) of the
    sheet; places: (k, 3) in `line` (p,), the sheet's nodes along the edge; elements: of Q = (φ, d, m); base:
    place of the held node, or None; offset: of the axis along the director [m]."""

    chains: Mapping[str, Chain]
    nodes: np.ndarray
    places: np.ndarray
    line: np.ndarray
    elements: RodElements
    base: int | None
    offset: float

    @property
    def chain(self) -> Chain:
        """First of the chains, which agree on their base, segments and plane."""
        return next(iter(self.chains.values()))


def of_scene(scene: Scene, plan: Plan) -> list[Rod]:
    """Return the rods of a scene's chains, one an edge. Raises BadInput for an edge that is not straight or
    has no node where a base is held."""
    return [_rod(scene, edge, chains, plan) for edge, chains in scene.chains().items()]


def _rod(scene: Scene, edge_name: str, chains: Mapping[str, Chain], plan: Plan) -> Rod:
    edge, chain_list, nodes = EDGES[edge_name], list(chains.values()), plan.nodes
    sides = Line.along(plan, plan.mesh.boundaries[edge_name]).nodes
    along = nodes[sides, edge.along_axis]
    if np.ptp(nodes[sides, edge.normal_axis]) > 1e-9 * np.ptp(along):
        raise BadInput(f"actuator: edge {edge_name} of the mesh is not straight")
    offsets = np.array([chain.axis_height(scene.sheet.thickness) for chain in chain_list])
    offset = float(offsets.mean())
    half = 0.5 * np.abs(along[:, 2] - along[:, 0])  # |dX/dξ|
    line = np.unique(sides)
    line = line[np.argsort(nodes[line, edge.along_axis])]
    places = np.argsort(line)[np.searchsorted(np.sort(line), sides)]
    reference = np.zeros((len(sides), 9, 3))  # Q₀
    reference[:, :3, :2] = nodes[sides]
    reference[:, 3:6, 2] = 1.0
    reference[:, 6:] = edge.outward
    start = scene.sheet.edge_ends(edge_name)[0][edge.along_axis]
    rigidity = np.array([chain.bending_stiffness for chain in chain_list])
    bending = INPLANE if chain_list[0].plane == "inplane" else NORMAL
    length = scene.sheet.lengths[edge.along_axis]
    intrinsic = np.zeros((len(sides), STRAINS, len(scene.actuators)))
    for chain, share in zip(chain_list, rigidity / rigidity.sum(), strict=True):
        mean = _mean_curvature(chain, length, along - start)
        intrinsic[:, bending, scene.actuators.index(chain)] += share * mean * half[:, None] ** 2
    forms = np.tile(_forms(offset), (len(sides), 1, 1, 1))
    stiffness = _stiffness(scene, chain_list[0].plane, float(rigidity.sum()), length, half)
    elements = RodElements(reference, forms, stiffness, intrinsic)
    base = _base(chain_list[0], nodes[line, edge.along_axis] - start, length)
    return Rod(chains, sides, places, line, elements, base, offset)


def _mean_curvature(chain: Chain, length: float, along: np.ndarray) -> np.ndarray:
    """Return the curvature at the two Gauss points (k, 2) with the work of the piecewise one on linear
    fields. along: distance from the start of the edge (k, 3) [m] of the sides' nodes."""
    bounds, values = chain.pieces() * length / chain.segments, chain.curvatures().at()
    xi = (np.arange(_SAMPLES) + 0.5) / _SAMPLES * 2.0 - 1.0
    at = along[:, :1] + 0.5 * (xi + 1.0) * (along[:, 2:] - along[:, :1])
    piece = np.clip(np.searchsorted(bounds, at) - 1, 0, len(values) - 1)
    return np.einsum("xg,ex->eg", lagrange(TWO, xi), values[piece]) * 2.0 / _SAMPLES


def _forms(offset: float) -> np.ndarray:
    """Return H (15, 9, 9) with ½ Qᵀ H Q the covariant strains."""
    zeros, node = np.zeros((2, 3)), np.eye(9)
    axis, director, bent, aside, bent_aside = (
        np.concatenate(parts, axis=1)
        for parts in (
            (_SLOPE, offset * _SLOPE, zeros),  # r'
            (zeros, _VALUE, zeros),
            (zeros, _SLOPE, zeros),
            (zeros, zeros, _VALUE),
            (zeros, zeros, _SLOPE),
        )
    )
    pairs = [(0.5 * axis, axis), (axis, director), (axis, aside), (-axis, bent), (-axis, bent_aside)]
    pairs += [(bent, aside), (node[3:6], node[6:])]
    return np.concatenate([products(a, b) for a, b in pairs])


def products(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return H (n, k, k) with ½ Qᵀ H Q = (a Q) · (b Q), of the rows of a and b (n, k)."""
    return np.einsum("ni,nj->nij", a, b) + np.einsum("ni,nj->nij", b, a)


def _stiffness(scene: Scene, plane: str, rigidity: float, length: float, half: np.ndarray) -> np.ndarray:
    """Return the stiffness (k, 15) of covariant strains: EI of elastic, `FIRM` times the sheet's of
    others."""
    young, thickness = scene.material.young, scene.sheet.thickness
    force = FIRM * young * thickness * length + SLENDER * rigidity / length**2
    out_of_plane = FIRM * young * thickness**3 * length + SLENDER * rigidity
    in_plane = FIRM * young * thickness * length**3 / 12.0 + SLENDER * rigidity
    out = np.zeros((len(half), STRAINS))
    covariant = half[:, None]
    out[:, AXIAL] = force * covariant**-3
    out[:, SHEAR] = out[:, ASIDE] = force * covariant**-1
    out[:, NORMAL] = (out_of_plane if plane == "inplane" else rigidity) * covariant**-3
    out[:, INPLANE] = (in_plane if plane == "normal" else rigidity) * covariant**-3
    out[:, TWIST] = out_of_plane * covariant**-1
    out[:, SQUARE] = force * _SHARES * covariant
    return out


def _base(chain: Chain, along: np.ndarray, length: float) -> int | None:
    """Return the place on the edge of the node that the base holds."""
    if chain.base == "free":
        return None
    at = {"start": 0.0, "middle": 0.5, "end": 1.0}[chain.base] * length
    nearest = int(np.argmin(np.abs(along - at)))
    if abs(along[nearest] - at) > 1e-9 * length:
        raise BadInput(f"actuator: no node of the mesh at the {chain.base} of edge {chain.edge}")
    return nearest


def hold_bases(supports: Supports, rods: Sequence[Rod]) -> Supports:
    """Return the supports with the rods' bases, which hold a node's position and director."""
    director, edges = supports.director.copy(), dict(supports.edges)
    for rod in rods:
        if rod.base is not None:
            node, held = rod.line[rod.base], np.zeros((len(director), 3), dtype=bool)
            held[node] = director[node] = True
            edges[rod.chain.held_as] = held
    return replace(supports, director=director, edges=edges)


@dataclass(frozen=True)
class BoundRods:
    """Rods of a scene among the vectors (N, 3) of a model, the sheet's first, then the rods' own. elements:
    all rods' sides; sites: (k, a) of Q among the model's vectors; vectors: of the rods at rest (q, 3),
    the last ones; held: (q,) whether a base holds them."""

    rods: tuple[Rod, ...]
    elements: RodElements
    sites: np.ndarray
    vectors: np.ndarray
    held: np.ndarray

    def by_rod(self, of_sides: np.ndarray) -> list[np.ndarray]:
        """Return values (k, …) of all sides, rod by rod."""
        return np.split(of_sides, np.cumsum([len(rod.nodes) for rod in self.rods])[:-1]) if self.rods else []


def bound(
    rods: Sequence[Rod],
    vectors: int,
    first: int,
    of_sheet: Callable[[Rod], tuple[RodElements, np.ndarray]],
    directors: int = 1,
) -> BoundRods:
    """Return the rods on a sheet with `first` vectors. of_sheet: returns a rod's sides, of `vectors` vectors
    each, and the indices of the first ones (k, …) among the sheet's. The last ones are `directors` directors
    of the rod's own at three nodes; each director has all nodes of a rod in sequence."""
    shapes = (vectors, 3), (1, vectors, vectors), (1,), (1, 0)
    empty = np.zeros((0, vectors), dtype=int), np.zeros((0, 3)), np.zeros(0, dtype=bool)
    parts = [(*empty, *(np.zeros((0, *shape)) for shape in shapes))]
    for rod in rods:
        (elements, on_sheet), (k, p) = of_sheet(rod), (len(rod.nodes), len(rod.line))
        on_rod = first + p * np.arange(directors)[:, None] + rod.places[:, None]
        at_rest = np.repeat(elements.reference[0, -3 * directors :: 3], p, axis=0)
        held = np.tile(np.arange(p) == (-1 if rod.base is None else rod.base), directors)
        parts.append((np.concatenate([on_sheet, on_rod.reshape(k, -1)], axis=1), at_rest, held, *elements))
        first += directors * p
    all_parts = zip(*(parts[1:] or parts), strict=True)
    sites, at_rest, held, *of_sides = map(np.concatenate, all_parts)
    return BoundRods(tuple(rods), RodElements(*of_sides), sites, at_rest, held)


def block_diagonal(blocks: Sequence[np.ndarray]) -> np.ndarray:
    """Return blocks (k, r, c) along the diagonal, (k, Σ r, Σ c)."""
    rows, columns = (np.cumsum([0, *(block.shape[axis] for block in blocks)]) for axis in (1, 2))
    out = np.zeros((len(blocks[0]), rows[-1], columns[-1]))
    for i, block in enumerate(blocks):
        out[:, rows[i] : rows[i + 1], columns[i] : columns[i + 1]] = block
    return out
