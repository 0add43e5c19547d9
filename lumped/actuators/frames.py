"""Rigid segments in natural coordinates: joint points, two directors a segment, and quadratic constraints.

Segment i of length ds between the points x_i and x_{i+1} has the frame t_i = (x_{i+1} − x_i)/ds, n_i, b_i.
Rows of the chain's displacement y, (rows, 3) [m]: the points, the n_i and the b_i (times ds, so that all are
lengths), then the multipliers, three a row. Everything the chain needs is then bilinear in the rows:

    rigidity    t·t = n·n = b·b = 1,  t·n = t·b = n·b = 0            of each segment that is not held
    joints      plane "normal": b·t' = b·n' = 0;  "inplane": n·t' = n·b' = 0;  "spatial": n·b' = b·n'
    measures    n·t', b·t', t·t' of each joint (the one a plane joint holds at zero is left out)

The mass matrix is constant, a mass offset from a segment is a constant linear map of its rows, and mean
values give differences exactly, which the conserving integrator needs. A held base is a frame that does not
move.

An end may be held at a corner whose director n_c is held too: a row n_c (times ds) a held end, before the
multipliers, and a joint of half length (but for "inplane") between n_c and the end's segment,

    corner      n_c·b = 0;  "inplane": n_c·b = n_c·t = 0;   measures n_c·t, 0, n_c·n

so that the segment may turn about n_c. A corner shared with another chain has the same joint; its n_c is free
but of unit length, and for one of the two chains a multiple of the other's (`lumped.actuators.corners`). What
the chains around it hold there already is left out (`SharedEnd`). Source: Betsch and Steinmann (2001), García
de Jalón's natural coordinates.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from sheetbench.scenes import Chain

T, N, B = range(3)


@dataclass(frozen=True)
class SharedEnd:
    """What a chain's end brings to a corner that another chain shares.

    own: whether the director's row is this chain's own; across, along: whether it makes n_c normal to its b
    and, if "inplane", to its t; level: of "inplane", whether it keeps the end at its height.
    """

    own: bool
    across: bool = True
    along: bool = True
    level: bool = True


class _Quantities:
    """Sums of products of two vectors less a target; terms: quantity, first, second and weight of each
    product."""

    def __init__(self) -> None:
        self.terms: list[tuple[int, int, int, float]] = []
        self.target: list[float] = []

    def add(self, value: float, *products: tuple[int, int, float]) -> None:
        """Another quantity: the weighted sum of products, less a value."""
        self.terms.extend((len(self.target), *product) for product in products)
        self.target.append(value)


class Frames:
    """Geometry of one chain. axes: the undeformed t, n, b as rows of a (3, 3) matrix; start: (3,) [m].

    held: ends (0, 1) held at a corner, at most one, and none with a base; shared: ends whose corner another
    chain shares.

    quantities: the constraints (first `constraints` of them), then three measures a joint.
    gradient and products below are with respect to the coordinate rows only, (coordinates, 3).
    """

    def __init__(
        self,
        chain: Chain,
        start: np.ndarray,
        length: float,
        axes: np.ndarray,
        held: tuple[int, ...] = (),
        shared: Mapping[int, SharedEnd] | None = None,
    ):
        count = chain.segments
        self.segments, self.length, self.axes, self.base = count, length / count, axes, chain.base
        self.points = count + 1
        self.held = held
        self.shared = dict(shared or {})
        self.corners = (*self.held, *self.shared)
        self.corner_row = {end: self.points + 2 * count + k for k, end in enumerate(self.corners)}
        self.coordinates = self.points + 2 * count + len(self.corners)
        points = start + self.length * np.arange(self.points)[:, None] * axes[T]
        directors = [np.tile(self.length * axes[kind], (count, 1)) for kind in (N, B)]
        normals = np.tile(self.length * axes[N], (len(self.corners), 1))
        self.rest = np.concatenate([points, *directors, normals])
        self.free = np.ones((self.coordinates, 3), dtype=bool)
        self.joints, fixed = self._joints(chain)
        self.free[fixed] = False
        self.base_points = [row for row in fixed if row < self.points]
        for end in self.held:
            self.free[[self.corner_row[end], self.end_point(end)]] = False
        quantities = _Quantities()
        self._constrain(chain, quantities)
        self.constraints = len(quantities.target)
        hinged = () if chain.plane == "inplane" else self.corners
        self._measure(chain, hinged, quantities)
        terms, target = quantities.terms, quantities.target
        self.target = np.array(target)
        index = np.array([term[:3] for term in terms], dtype=int).reshape(-1, 3)  # one held segment has none
        self._quantity, self._first, self._second = index.T
        self._weight = np.array([term[3] for term in terms])
        self._map = self._linear_map()
        ground = np.zeros((3 * count + 3 + len(self.corners), 3))
        ground[3 * count : 3 * count + 3] = axes
        self._constant = ground + self._map @ self.rest
        self.share = np.array([share for _, _, share in self.joints] + [0.5] * len(hinged))
        ends = [0 if end == 0 else len(self.joints) - 1 for end in hinged]
        self.command = np.array([*range(len(self.joints)), *ends], dtype=int)  # whose curvature a joint has

    def _constrain(self, chain: Chain, quantities: _Quantities) -> None:
        """Rigid segments that are not held, joints of the plane, held and shared corners."""
        level = self._joints_left_level()
        for i in range(self.segments):
            if self._held(i):
                continue
            for first, second in ((T, T), (N, N), (B, B), (T, N), (T, B), (N, B)):
                same = first == second
                pair = (self._vector(i, first), self._vector(i, second), 0.5 if same else 1.0)
                quantities.add(0.5 * same, pair)
        for joint, (before, after, _) in enumerate(self.joints):
            for products in _JOINT_CONSTRAINTS[chain.plane][joint in level :]:
                pairs = [(self._vector(before, p), self._vector(after, q), w) for p, q, w in products]
                quantities.add(0.0, *pairs)
        for end in self.corners:
            here = self.shared.get(end, SharedEnd(own=False, along=not level or bool(self.joints)))
            if here.own:
                quantities.add(0.5, (self._corner(end), self._corner(end), 0.5))
            kinds = [B] * here.across + [T] * (here.along and chain.plane == "inplane")
            for kind in kinds:
                pair = (self._corner(end), self._vector(self.end_segment(end), kind), 1.0)
                quantities.add(0.0, pair)

    def _joints_left_level(self) -> set[int]:
        """Joints beside ends that are kept at their height by what they share a corner with. Such a joint,
        or without joints the held corner, leaves n·t' = 0 out: it follows from the rest."""
        ends = [end for end, here in self.shared.items() if not here.level]
        return {(len(self.joints) - 1) * end for end in ends}

    def _measure(self, chain: Chain, hinged: tuple[int, ...], quantities: _Quantities) -> None:
        """Three measures of every joint, and of those between corners and the segments hinged to them."""
        for before, after, _ in self.joints:
            for first in (N, B):
                weight = float(first in _MEASURED[chain.plane])
                quantities.add(0.0, (self._vector(before, first), self._vector(after, T), weight))
            quantities.add(0.0, (self._vector(before, T), self._vector(after, T), 1.0))
        for end in hinged:
            corner, segment = self._corner(end), self.end_segment(end)
            for kind, weight in ((T, 1.0 if end == 0 else -1.0), (B, 0.0), (N, 1.0)):
                quantities.add(0.0, (corner, self._vector(segment, kind), weight))

    @property
    def multiplier_rows(self) -> int:
        """Rows of three that hold the multipliers."""
        return -(-self.constraints // 3)

    def vectors(self, y: np.ndarray) -> np.ndarray:
        """t, n, b of the segments and the ground, then every n_c, (3 segments + 3 + corners, 3), at
        coordinate displacements y."""
        v: np.ndarray = self._constant + self._map @ y[: self.coordinates]
        return v

    def products(self, v: np.ndarray) -> np.ndarray:
        """The quantities, (k,): constraints as residuals, then measures."""
        values = self._weight * (v[self._first] * v[self._second]).sum(axis=1)
        return np.bincount(self._quantity, values, minlength=len(self.target)) - self.target

    def gradient(self, v: np.ndarray) -> np.ndarray:
        """Derivatives (k, coordinates, 3) of the quantities by the coordinate rows."""
        by_row: np.ndarray = np.matmul(self._map.T, self._by_vector(v))
        return by_row

    def ground_couple(self, v: np.ndarray, multipliers: np.ndarray) -> np.ndarray:
        """Moment (3,) [N·m] that keeps the ground's frame from turning: Σ v × Σ multiplier × slope by v."""
        ground = slice(3 * self.segments, 3 * self.segments + 3)
        pull = np.tensordot(multipliers, self._by_vector(v)[:, ground], axes=1)
        couple: np.ndarray = np.cross(v[ground], pull).sum(axis=0)
        return couple

    def _by_vector(self, v: np.ndarray) -> np.ndarray:
        """Derivatives (k, vectors, 3) of the quantities by the vectors."""
        out = np.zeros((len(self.target), len(v), 3))
        np.add.at(out, (self._quantity, self._first), self._weight[:, None] * v[self._second])
        np.add.at(out, (self._quantity, self._second), self._weight[:, None] * v[self._first])
        return out

    def curvature_of(self, multipliers: np.ndarray) -> np.ndarray:
        """Σ multiplier × second derivative of its quantity, (coordinates, coordinates), for each axis."""
        coupled = np.zeros((len(self._constant), len(self._constant)))
        np.add.at(coupled, (self._first, self._second), self._weight * multipliers[self._quantity])
        form: np.ndarray = self._map.T @ (coupled + coupled.T) @ self._map
        return form

    def pairs(self) -> np.ndarray:
        """Rows, multipliers included, that appear together in the tangent or the mass matrix, (r, r) bool."""
        touched = np.zeros((len(self.target), len(self._constant)), dtype=bool)
        touched[self._quantity, self._first] = touched[self._quantity, self._second] = True
        by_row = touched @ (self._map != 0.0)
        joints = by_row[self.constraints :].reshape(-1, 3, self.coordinates).any(axis=1)
        bodies, i = np.zeros((self.segments, self.coordinates), dtype=bool), np.arange(self.segments)
        bodies[i, i] = bodies[i, i + 1] = bodies[i, self.points + i] = True
        together = np.concatenate([by_row[: self.constraints], joints, bodies])
        multipliers = np.zeros((3 * self.multiplier_rows, self.coordinates), dtype=bool)
        multipliers[: self.constraints] = by_row[: self.constraints]
        of_rows = multipliers.reshape(-1, 3, self.coordinates).any(axis=1)
        count, whole = self.coordinates, np.eye(self.coordinates + self.multiplier_rows, dtype=bool)
        whole[:count, :count] |= together.T @ together
        whole[count:, :count], whole[:count, count:] = of_rows, of_rows.T
        return whole

    @property
    def base_joint(self) -> int | None:
        """The joint or end (0 to segments) at which a base is a frame that joints join; None without one."""
        even = self.segments % 2 == 0
        return {"start": 0, "end": self.segments, "middle": self.segments // 2 if even else None}.get(
            self.base
        )

    def end_point(self, end: int) -> int:
        """The point at an end (0 or 1)."""
        return end * self.segments

    def end_segment(self, end: int) -> int:
        """The segment at an end (0 or 1)."""
        return end * (self.segments - 1)

    def _corner(self, end: int) -> int:
        return 3 * self.segments + 3 + self.corners.index(end)

    def _vector(self, frame: int, kind: int) -> int:
        return 3 * self.segments + kind if frame == self.segments else kind * self.segments + frame

    def _held(self, segment: int) -> bool:
        return self.base == "middle" and self.segments % 2 == 1 and segment == self.segments // 2

    def _joints(self, chain: Chain) -> tuple[list[tuple[int, int, float]], list[int]]:
        """(frame before, frame after, length in ds) of every joint in order, and the rows held still."""
        count, ground = self.segments, self.segments
        inner = [(i, i + 1, 1.0) for i in range(count - 1)]
        middle = count // 2
        if chain.base == "start":
            return [(ground, 0, 0.5), *inner], [0]
        if chain.base == "end":
            return [*inner, (count - 1, ground, 0.5)], [count]
        if chain.base == "middle" and count % 2 == 0:
            halves = [(middle - 1, ground, 0.5), (ground, middle, 0.5)]
            return [*inner[: middle - 1], *halves, *inner[middle:]], [middle]
        if chain.base == "middle":
            points = self.points
            return inner, [middle, middle + 1, points + middle, points + count + middle]
        return inner, []

    def _linear_map(self) -> np.ndarray:
        """(3 segments + 3 + corners, coordinates): frames from rows, a unit a row of length ds."""
        count = self.segments
        out = np.zeros((3 * count + 3 + len(self.corners), self.coordinates))
        i = np.arange(count)
        out[i, i + 1], out[i, i] = 1.0 / self.length, -1.0 / self.length
        for kind in (N, B):
            out[kind * count + i, self.points + (kind - 1) * count + i] = 1.0 / self.length
        for end, row in self.corner_row.items():
            out[self._corner(end), row] = 1.0 / self.length
        return out


_JOINT_CONSTRAINTS = {
    "normal": (((B, T, 1.0),), ((B, N, 1.0),)),
    "inplane": (((N, T, 1.0),), ((N, B, 1.0),)),
    "spatial": (((N, B, 1.0), (B, N, -1.0)),),
}
_MEASURED = {"normal": (N,), "inplane": (B,), "spatial": (N, B)}
