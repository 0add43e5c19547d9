"""Rigid segments in natural coordinates: joint points, two directors a segment, and quadratic constraints.

Segment i of length ds between the points x_i and x_{i+1} has the frame t_i = (x_{i+1} − x_i)/ds, n_i, b_i.
Rows of the chain's displacement y, (rows, 3) [m]: the points, the n_i and the b_i (times ds, so that all are
lengths), then the multipliers, three a row. Everything the chain needs is then bilinear in the rows:

    rigidity    t·t = n·n = b·b = 1,  t·n = t·b = n·b = 0            of each segment
    joints      plane "normal": b·t' = b·n' = 0;  "inplane": n·t' = n·b' = 0;  "spatial": n·b' = b·n'
    measures    n·t', b·t', t·t' of each joint (the one a plane joint holds at zero is left out)

The mass matrix is constant, a mass offset from a segment is a constant linear map of its rows, and mean
values give differences exactly, which the conserving integrator needs. A held base is a frame that does not
move.

An end may be held at a corner whose director n_c is held too: a row n_c (times ds) a held end, before the
multipliers, and a joint of half length (but for "inplane") between n_c and the end's segment,

    corner      n_c·b = 0;  "inplane": n_c·b = n_c·t = 0;   measures n_c·t, 0, n_c·n

so that the segment may turn about n_c. A corner shared with another chain has this joint too; its n_c is free
but of unit length, and for one of the two chains a multiple of the other's (`lumped.actuators.corners`).
Source: Betsch and Steinmann (2001), García de Jalón's natural coordinates.
"""

from collections.abc import Iterator, Mapping
from itertools import combinations_with_replacement, pairwise
from typing import NamedTuple

import numpy as np

from sheetbench.scenes import Chain

Product = tuple[int, int, float]  # two vectors and the weight of their scalar product

T, N, B = range(3)


class Measured(NamedTuple):
    """Constraints and joint measures at a displacement. vectors: (v, 3) t, n, b of the segments and of the
    ground, then every n_c; residuals: (c,) of the constraints; measures: (j, 3) of the joints; slopes: (k, v,
    3) derivatives of the quantities by the vectors."""

    vectors: np.ndarray
    residuals: np.ndarray
    measures: np.ndarray
    slopes: np.ndarray


class Frames:
    """Geometry of one chain. axes: the undeformed t, n, b as rows of a (3, 3) matrix; start: (3,) [m].

    held: ends (0, 1) held at a corner, at most one, and none with a base; shared: ends whose corner another
    chain shares, and whether the director's row there is this chain's own. A base in the middle needs an even
    number of segments.

    base_joint: the joint or end (0 to segments) at which a base is a frame that joints join, None without
    one. joints: frame before, frame after and length in ds of every joint in order, the ground's frame being
    `segments`. quantities: the constraints (first `constraints` of them), then three measures a joint; rank:
    (constraints,) 0 of a constraint that is always independent, else the order in which
    `redundant_constraints` tests it.
    """

    def __init__(
        self,
        chain: Chain,
        start: np.ndarray,
        length: float,
        axes: np.ndarray,
        held: tuple[int, ...] = (),
        shared: Mapping[int, bool] | None = None,
    ):
        count = ground = chain.segments
        self.segments, self.length, self.axes, self.points = count, length / count, axes, count + 1
        self.base_joint = {"start": 0, "middle": count // 2, "end": count}.get(chain.base)
        self.held, self.shared = held, dict(shared or {})
        self.corners = (*self.held, *self.shared)
        self.corner_row = {end: self.points + 2 * count + k for k, end in enumerate(self.corners)}
        self.coordinates = self.points + 2 * count + len(self.corners)
        points = start + self.length * np.arange(self.points)[:, None] * axes[T]
        directors = [np.tile(self.length * axes[kind], (count, 1)) for kind in (N, B)]
        normals = np.tile(self.length * axes[N], (len(self.corners), 1))
        self.rest = np.concatenate([points, *directors, normals])
        self.free = np.ones((self.coordinates, 3), dtype=bool)
        self.free[[] if self.base_joint is None else self.base_joint] = False
        for end in self.held:
            self.free[[self.corner_row[end], self.end_point(end)]] = False
        self.joints: list[tuple[int, int, float]] = []
        for point in range(count + 1):
            based = point == self.base_joint
            joined = [point - 1] * (point > 0) + [ground] * based + [point] * (point < count)
            self.joints += [(*pair, 0.5 if based else 1.0) for pair in pairwise(joined)]
        constraints = list(self._constraints(chain.plane))
        self.rank = np.array([rank for rank, _, _ in constraints])
        self.constraints = len(constraints)
        hinged = () if chain.plane == "inplane" else self.corners
        quantities = [*(products for _, _, products in constraints), *self._measures(chain.plane, hinged)]
        terms = [(number, *product) for number, products in enumerate(quantities) for product in products]
        self._target = np.zeros(len(quantities))
        self._target[: self.constraints] = [target for _, target, _ in constraints]
        self._quantity, self._first, self._second = np.array([term[:3] for term in terms]).T
        self._weight = np.array([term[3] for term in terms])
        self._map = self._linear_map()
        base = np.zeros((3 * count + 3 + len(self.corners), 3))
        base[3 * count : 3 * count + 3] = axes
        self._constant = base + self._map @ self.rest
        self.share = np.array([share for _, _, share in self.joints] + [0.5] * len(hinged))
        ends = [0 if end == 0 else len(self.joints) - 1 for end in hinged]
        self.command = np.array([*range(len(self.joints)), *ends], dtype=int)  # whose curvature a joint has

    def _constraints(self, plane: str) -> Iterator[tuple[int, float, list[Product]]]:
        """Yield rank, target and products of the constraints: rigid segments, joints of the plane, held and
        shared corners."""
        for i in range(self.segments):
            for first, second in combinations_with_replacement((T, N, B), 2):
                same = 0.5 * (first == second)
                yield 0, same, [(self._vector(i, first), self._vector(i, second), 1.0 - same)]
        level = {(len(self.joints) - 1) * end for end in self.shared} if plane == "inplane" else ()
        for joint, (before, after, _) in enumerate(self.joints):
            for number, products in enumerate(_JOINT_CONSTRAINTS[plane]):
                pairs = [(self._vector(before, p), self._vector(after, q), w) for p, q, w in products]
                yield int(joint in level and number == 0), 0.0, pairs
        for end in self.corners:
            corner, segment = self._corner(end), self.end_segment(end)
            if self.shared.get(end, False):
                yield 0, 0.5, [(corner, corner, 0.5)]
            for rank, kind in ((2, B), (3, T))[: 1 + (plane == "inplane")]:
                yield rank * (end in self.shared), 0.0, [(corner, self._vector(segment, kind), 1.0)]

    def _measures(self, plane: str, hinged: tuple[int, ...]) -> Iterator[list[Product]]:
        """Yield the products of three measures of every joint, also between corners and segments."""
        for before, after, _ in self.joints:
            for first in (N, B, T):
                weight = float(first == T or first in _MEASURED[plane])
                yield [(self._vector(before, first), self._vector(after, T), weight)]
        for end in hinged:
            for kind, weight in ((T, 1.0 if end == 0 else -1.0), (B, 0.0), (N, 1.0)):
                yield [(self._corner(end), self._vector(self.end_segment(end), kind), weight)]

    def at(self, y: np.ndarray) -> Measured:
        """Return the constraints' residuals, the joint measures and their slopes at coordinate displacements
        y. Each is bilinear in the vectors, hence half the product of its slopes and the vectors."""
        v = self._constant + self._map @ y[: self.coordinates]
        slopes = np.zeros((len(self._target), len(v), 3))
        np.add.at(slopes, (self._quantity, self._first), self._weight[:, None] * v[self._second])
        np.add.at(slopes, (self._quantity, self._second), self._weight[:, None] * v[self._first])
        values = 0.5 * np.tensordot(slopes, v, 2) - self._target
        return Measured(v, values[: self.constraints], values[self.constraints :].reshape(-1, 3), slopes)

    def gradient(self, slopes: np.ndarray) -> np.ndarray:
        """Return derivatives (k, coordinates, 3) of the quantities by the coordinate rows."""
        return np.matmul(self._map.T, slopes)

    def ground_couple(self, at: Measured, weights: np.ndarray) -> np.ndarray:
        """Return the moment (3,) [N·m] that holds the orientation of the ground's frame: Σ v × Σ weight ×
        slope by v."""
        ground = slice(3 * self.segments, 3 * self.segments + 3)
        pull = np.tensordot(weights, at.slopes[:, ground], axes=1)
        return np.cross(at.vectors[ground], pull).sum(axis=0)

    def curvature_of(self, weights: np.ndarray) -> np.ndarray:
        """Return Σ weight × second derivative of its quantity, (coordinates, coordinates), for each axis."""
        coupled = np.zeros((len(self._constant), len(self._constant)))
        np.add.at(coupled, (self._first, self._second), self._weight * weights[self._quantity])
        return self._map.T @ (coupled + coupled.T) @ self._map

    def end_point(self, end: int) -> int:
        """Return the number of the point at an end (0 or 1)."""
        return end * self.segments

    def end_segment(self, end: int) -> int:
        """Return the number of the segment at an end (0 or 1)."""
        return end * (self.segments - 1)

    def _corner(self, end: int) -> int:
        return 3 * self.segments + 3 + self.corners.index(end)

    def _vector(self, frame: int, kind: int) -> int:
        return 3 * self.segments + kind if frame == self.segments else kind * self.segments + frame

    def _linear_map(self) -> np.ndarray:
        """Return the map (3 segments + 3 + corners, coordinates) from rows to the frames' vectors."""
        count = self.segments
        out = np.zeros((3 * count + 3 + len(self.corners), self.coordinates))
        i = np.arange(count)
        out[i, i + 1], out[i, i] = 1.0, -1.0
        out[count + np.arange(2 * count), self.points + np.arange(2 * count)] = 1.0
        for end, row in self.corner_row.items():
            out[self._corner(end), row] = 1.0
        return out / self.length


_JOINT_CONSTRAINTS = {
    "normal": (((B, T, 1.0),), ((B, N, 1.0),)),
    "inplane": (((N, T, 1.0),), ((N, B, 1.0),)),
    "spatial": (((N, B, 1.0), (B, N, -1.0)),),
}
_MEASURED = {"normal": (N,), "inplane": (B,), "spatial": (N, B)}
