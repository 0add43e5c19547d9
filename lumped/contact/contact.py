"""Contact of the sheet with one rigid obstacle: a penalty on the mid-surface, offset by half the thickness.

With the distance φ from the obstacle (`lumped.contact.surface`), the gap g = φ − h/2 and the depth
d = ⟨δ₀ − g⟩, δ₀ = 1e-9 h so that a sheet that lies on a plane is held by it, a point of area A has

    energy A ½ k d²,   pressure p = k d,   force A p n,   tangent A (k n nᵀ − p H) where p > 0.

k = E/h is the sheet's own give through its thickness, which neither model resolves: bending contact has p/E
of 1e-6 to 1e-4, so that the depth p h/E is far below 1e-3 h. `share` scales k: statics begin with a soft one
(`sheetbench.numerics.continuation.stiffening`).

Points are the columns of masses, with their tributary areas, on a plane. On a sphere or cylinder the masses
alone sample the contact to first order only: each side l of a cell is in s parts, s = max(2, ⌈2 l/R⌉), with
l as far as it is across a cylinder's axis, and points are at their middles; at their ends, masses among
them, of a sheet that rests on the obstacle, or nothing would hold it at the start. A point's force is shared
as its position is made up, by the layers equally.

In motion k is 0.1 ρ h ω_max² at most and the law is rounded over δ = 0.3 h, or every touch costs explicit
steps energy: ψ = k d³/6δ up to δ, beyond k (d²/2 − δ d/2 + δ²/6). Conserving midpoint steps have the mean
force −A (Δψ/Δφ) n̄ (Gonzalez, 1996). A dashpot p (1 + τ ḋ) ≥ 0 takes ∮ p τ ḋ² dt (Hunt and Crossley, 1975):
m v dv = −p (1 + τ v) dd leads from a speed v to e v with, whatever the law p(d),

    v/τ − ln(1 + τ v)/τ² = −e v/τ − ln(1 − τ e v)/τ²,   e = 1 − 2 τ v/3 + O(τ²v²).

Friction is regularised Coulomb, −μ p A v_t/√(v_t² + v₀²), v₀ = 1 mm/s: it creeps where it should stick.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lumped.actuators import Drive
from lumped.assembly import Assembly
from lumped.contact.law import rounded_law, side_rule
from lumped.contact.surface import At, ObstacleSurface
from sheetbench.answers.contact import ContactState
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, free_rigid_motions
from sheetbench.scenes.meaning.composition import constants_at
from sheetbench.scenes.meaning.distances import obstacles_by_name
from sheetbench.scenes.objects.obstacles import SLIP_SPEED, AnyObstacle

if TYPE_CHECKING:
    from lumped.statics.problem import Problem

TOUCH = 1e-9  # δ₀, of the thickness
UNDECIDED = 1e-6  # of the thickness, or 1e-3 of the deepest: points as near as that to touching
FINEST = 32  # points a side of a cell
DEEPEST = 0.5  # of the radius: how deep no step may take a point
MOVING = 0.13  # of ω_max², what contact in motion adds at most: 0.1 in the interior, where A ρ h is the mass
ROUNDED = 0.3  # δ of the thickness, in motion
SAME_DEPTH = 1e-7  # of the thickness, by which depths differ of which the mean force is that of the mean


class _Touching(NamedTuple):
    """Where some patches of points are: which, their points, depth less than 0 included [m], A k [N/m], and
    A ψ [J], A p [N] and A p' [N/m] (m, p)."""

    patches: np.ndarray
    at: At
    depth: np.ndarray
    stiffness: np.ndarray
    energy: np.ndarray
    load: np.ndarray
    slope: np.ndarray


class Contact:
    """Contact of a lattice with an obstacle. Points are in patches of the same masses, cells or columns:
    nodes (m, q), weights (p, q) of each of the p points of a patch."""

    def __init__(self, scene: Scene, assembly: Assembly, name: str, obstacle: AnyObstacle):
        self.name, self.obstacle, self.surface = name, obstacle, ObstacleSurface(obstacle)
        self.moves, self.radius = obstacle.motion is not None, self.surface.radius
        self.moved = float(np.linalg.norm(obstacle.displacement(1.0)))
        lattice = assembly.lattice
        columns, areas = lattice.columns(), lattice.cell_areas
        # cells' sides as far as they are across the obstacle's axis
        sides = [
            line.widths.max() * np.linalg.norm(self.surface.projector[i])
            for i, line in enumerate(lattice.lines)
        ]
        self.cell = float(max(sides))
        per_side = [max(2, math.ceil(2.0 * side / self.surface.radius)) for side in sides]
        if max(per_side) > FINEST:
            least = 2e3 * self.cell / FINEST
            raise BadInput(
                f"{name}.radius = {self.surface.radius:g}: too thin for cells of {1e3 * self.cell:.3g} mm, "
                f"which would step over it; {least:.3g} mm or more, or a finer grid"
            )
        if self.surface.flat:
            quarters = 0.25 * areas
            plan = sum(np.pad(quarters, ((1 - j, j), (1 - i, i))) for j in range(2) for i in range(2))
            self.nodes, area = columns.reshape(-1, columns.shape[2]), np.asarray(plan).reshape(-1, 1)
            self.weights = np.full((1, columns.shape[2]), 1.0 / columns.shape[2])
        else:
            corners = columns[:-1, :-1], columns[:-1, 1:], columns[1:, :-1], columns[1:, 1:]
            self.nodes = np.concatenate(corners, axis=2).reshape(areas.size, -1)
            resting = bool(free_rigid_motions(scene))
            (along_x, width), (along_y, height) = (side_rule(parts, resting) for parts in per_side)
            bilinear = np.einsum("ja,ib->jiab", along_y, along_x).reshape(-1, 4)
            self.weights = np.repeat(bilinear, columns.shape[2], axis=1) / columns.shape[2]
            area = areas.reshape(-1, 1) * np.outer(height, width).ravel()
        there = area[:, 0] > 0.0
        self.nodes, self.area = np.ascontiguousarray(self.nodes[there]), area[there]
        self._rest = lattice.positions[self.nodes]
        plan_points = (self.weights @ self._rest)[..., :2].reshape(-1, 2)
        constants = constants_at(scene, plan_points)
        shape = self.area.shape
        of_points = (constants.thickness, constants.stretching)
        self.thickness, stretching = (
            np.broadcast_to(part, self.area.size).reshape(shape) for part in of_points
        )
        self.full = stretching / self.thickness**2
        self.share, self.rounded, self._masses = 1.0, 0.0, lattice.mass_count
        self.slots = assembly.pattern.among(self.nodes)
        self._eps = assembly.rounding

    def _origin(self, drive: Drive) -> np.ndarray:
        return self.obstacle.position + self.obstacle.displacement(drive.load_factor, drive.time)

    def _at(self, u: np.ndarray, drive: Drive, far: bool = False) -> _Touching:
        """Where patches are that may touch, or all."""
        places = self._rest + u[self.nodes] - self._origin(drive)
        which = np.arange(len(places))
        if len(self.weights) > 1 and not far:  # no point is farther from the middle than the farthest mass
            middle = places.mean(axis=1, keepdims=True)
            reach = np.sqrt(((places - middle) ** 2).sum(axis=2).max(axis=1)) + 0.51 * self.thickness.max(
                axis=1
            )
            which = np.flatnonzero(self.surface.at(middle[:, 0]).distance < reach)
        at = self.surface.at(self.weights @ places[which])
        thickness = self.thickness[which]
        depth = (0.5 + TOUCH) * thickness - at.distance
        stiffness = self.share * self.full[which] * self.area[which]
        law = rounded_law(depth, self.rounded * thickness)
        return _Touching(which, at, depth, stiffness, *(stiffness * part for part in law))

    def _spread(self, patches: np.ndarray, load: np.ndarray, out: np.ndarray) -> None:
        """Add forces of points (m, p, 3) [N] to those of the masses."""
        touched = load.any(axis=(1, 2))
        shares = np.einsum("pq,mpi->mqi", self.weights, load[touched])
        np.add.at(out, self.nodes[patches[touched]], shares)

    def _spread_blocks(self, patches: np.ndarray, points: np.ndarray, blocks: np.ndarray) -> None:
        """Add derivatives at points (m, p, 3, 3) to the pattern's blocks."""
        touched = points.any(axis=(1, 2, 3))
        of_masses = np.einsum("pa,pb,mpij->mabij", self.weights, self.weights, points[touched], optimize=True)
        np.add.at(blocks, self.slots[patches[touched]], of_masses)

    def add_force(self, u: np.ndarray, drive: Drive, force: np.ndarray) -> float:
        """Add the internal force (n, 3) [N] at u (n, 3) [m]; return the energy [J]."""
        found = self._at(u, drive)
        self._spread(found.patches, -found.load[..., None] * found.at.normal, force)
        return float(found.energy.sum())

    def add_tangent(
        self, u: np.ndarray, drive: Drive, scale: float, blocks: np.ndarray, definite: bool = False
    ) -> None:
        """Add scale × the tangent; definite: without the obstacle's curvature."""
        found = self._at(u, drive)
        normal = found.at.normal
        points = (scale * found.slope)[..., None, None] * normal[..., :, None] * normal[..., None, :]
        if not definite:
            points = points - (scale * found.load)[..., None, None] * self.surface.curvature(found.at)
        self._spread_blocks(found.patches, points, blocks)

    def _secant(
        self, start: np.ndarray, end: np.ndarray, drives: tuple[Drive, Drive]
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return A × the mean pressure −Δψ/Δφ (m, p) [N], A × its derivative by the depth at the end [N/m],
        and n̄ (m, p, 3)."""
        before, after = (self._at(u, drive, True) for u, drive in zip((start, end), drives, strict=True))
        sunk = after.depth - before.depth
        far = np.abs(sunk) > SAME_DEPTH * self.thickness
        over = np.where(far, sunk, 1.0)
        _, load, slope = (
            after.stiffness * part
            for part in rounded_law(0.5 * (before.depth + after.depth), self.rounded * self.thickness)
        )
        mean = np.where(far, (after.energy - before.energy) / over, load)
        slope = np.where(far, (after.load - mean) / over, 0.5 * slope)
        return mean, slope, self.surface.mean_normal(before.at, after.at)

    def add_average_force(
        self, start: np.ndarray, end: np.ndarray, drives: tuple[Drive, Drive], force: np.ndarray
    ) -> None:
        """Add the force whose work from start to end is the energy stored."""
        load, _, normal = self._secant(start, end, drives)
        self._spread(np.arange(len(self.nodes)), -load[..., None] * normal, force)

    def add_average_tangent(
        self, start: np.ndarray, end: np.ndarray, drives: tuple[Drive, Drive], blocks: np.ndarray
    ) -> None:
        """Add its derivative by `end`, the symmetric part of it."""
        load, slope, normal = self._secant(start, end, drives)
        points = slope[..., None, None] * normal[..., :, None] * normal[..., None, :]
        at = self._at(end, drives[1], True).at
        points = points - (0.5 * load)[..., None, None] * self.surface.curvature(at)
        self._spread_blocks(np.arange(len(self.nodes)), points, blocks)

    @property
    def resists(self) -> bool:
        """Whether it takes energy."""
        return self.obstacle.friction > 0.0 or self.obstacle.contact_damping > 0.0

    def _sliding(
        self, u: np.ndarray, v: np.ndarray, drive: Drive
    ) -> tuple[_Touching, np.ndarray, np.ndarray, np.ndarray]:
        """Where points are, how fast they leave the obstacle (m, p), slide (m, p, 3), and √(v_t² + v₀²)
        [m/s]."""
        found = self._at(u, drive)
        speed = self.weights @ (v[self.nodes[found.patches]] - self._velocity(drive.time))
        leaving = (speed * found.at.normal).sum(axis=-1)
        sliding = speed - leaving[..., None] * found.at.normal
        return found, leaving, sliding, np.sqrt((sliding**2).sum(axis=-1) + SLIP_SPEED**2)

    def _velocity(self, time: float | None) -> np.ndarray:
        if self.obstacle.motion is None or time is None:
            return np.zeros(3)
        return np.asarray(self.obstacle.motion.course.slope(time))

    def add_resistance(self, u: np.ndarray, v: np.ndarray, drive: Drive, force: np.ndarray) -> float:
        """Add dashpot and friction at velocity v (n, 3) [m/s]; return the power taken [W]."""
        if not self.resists:
            return 0.0
        found, leaving, sliding, size = self._sliding(u, v, drive)
        load = found.load
        damped = load * np.minimum(self.obstacle.contact_damping * leaving, 1.0)
        rubbed = self.obstacle.friction * load / size
        resisting = damped[..., None] * found.at.normal + rubbed[..., None] * sliding
        self._spread(found.patches, resisting, force)
        return float((damped * leaving).sum() + (rubbed * (size**2 - SLIP_SPEED**2)).sum())

    def add_resistance_tangent(
        self, u: np.ndarray, v: np.ndarray, drive: Drive, scale: float, blocks: np.ndarray
    ) -> None:
        """Add scale × its derivative by the velocity."""
        if not self.resists:
            return
        found, leaving, sliding, size = self._sliding(u, v, drive)
        tau, load = self.obstacle.contact_damping, scale * found.load
        outer = found.at.normal[..., :, None] * found.at.normal[..., None, :]
        damped = tau * load * (tau * leaving < 1.0)
        rubbed = self.obstacle.friction * load / size
        unit = sliding / size[..., None]
        plane = np.eye(3) - outer - unit[..., :, None] * unit[..., None, :]
        points = damped[..., None, None] * outer + rubbed[..., None, None] * plane
        self._spread_blocks(found.patches, points, blocks)

    def exerted(self, u: np.ndarray, drive: Drive, v: np.ndarray | None = None) -> np.ndarray:
        """Return its forces on the masses (n, 3) [N]."""
        force = np.zeros_like(u)
        self.add_force(u, drive, force)
        if v is not None:
            self.add_resistance(u, v, drive, force)
        return -force

    def work(self, force: np.ndarray, start: float, end: float) -> float:
        """Return the work [J] of a force (3,) [N] of the obstacle on the sheet between two times [s]."""
        moved = self.obstacle.displacement(1.0, end) - self.obstacle.displacement(1.0, start)
        return float(force @ moved)

    def power(self, force: np.ndarray, time: float) -> float:
        """Return its power [W] at a time [s]."""
        return float(force @ self._velocity(time))

    def step_share(self, u: np.ndarray, move: np.ndarray, drive: Drive, since: Drive | None = None) -> float:
        """Return the share of a move (n, 3) [m] that takes no point deeper than half a radius, nor through;
        since: where the obstacle is as it begins."""
        if self.surface.flat:
            return 1.0
        x = self._at(u, since or drive, True).at.across
        moved = self._origin(drive) - self._origin(since or drive)
        v = (self.weights @ move[self.nodes] - moved) @ self.surface.projector
        core = DEEPEST * self.surface.radius + 0.5 * self.thickness
        a, b, c = (v * v).sum(axis=-1), (x * v).sum(axis=-1), (x * x).sum(axis=-1) - core**2
        hit = (b * b > a * c) & (b < 0.0) & (c > 0.0)
        if not hit.any():
            return 1.0
        first = (-b[hit] - np.sqrt((b * b - a * c)[hit])) / a[hit]
        return float(min(1.0, 0.99 * first.min()))

    def _over_mass(self, mass: np.ndarray) -> float:
        """Return k A/m at its largest [1/s²], of the whole stiffness."""
        stiffness = np.zeros(self._masses)
        np.add.at(stiffness, self.nodes, (self.area * self.full) @ self.weights)
        return float((stiffness / mass).max())

    def stiffest(self, mass: np.ndarray) -> float:
        """Return by how much contact may raise ω² [1/s²]; mass: of the lumped masses (n,) [kg]."""
        return self.share * self._over_mass(mass)

    def move_freely(self, mass: np.ndarray, squared: float) -> None:
        """Take 0.1 ρ h ω² for k where it is less, so that steps need be no shorter than without."""
        self.rounded = ROUNDED
        self.share = min(1.0, MOVING / self._over_mass(mass) * squared)

    def rounding(self) -> float:
        """Return what rounding of positions leaves of its forces, as a norm [N]."""
        return self._eps * float(
            np.linalg.norm(self.area * self.share * self.full) * np.abs(self._rest).max()
        )

    def report(self, u: np.ndarray, drive: Drive) -> ContactState:
        """Return the area in contact, the deepest penetration over the thickness, points touching and
        undecided."""
        found = self._at(u, drive)
        over = found.depth / self.thickness[found.patches] - TOUCH
        touching, area = found.depth > 0.0, self.area[found.patches]
        near = np.minimum(UNDECIDED, 1e-3 * over.max(initial=0.0))
        return ContactState(
            area=float(area[touching].sum()),
            penetration=float(over.max(initial=0.0)),
            points=int(touching.sum()),
            undecided=int((np.abs(over) <= near).sum()),
        )

    def pressure(self, u: np.ndarray, drive: Drive) -> np.ndarray:
        """Return the pressure [Pa] of every mass's column (n,), of forces by tributary areas."""
        found = self._at(u, drive)
        load, area = np.zeros(self._masses), np.zeros(self._masses)
        np.add.at(load, self.nodes[found.patches], found.load @ self.weights)
        np.add.at(area, self.nodes, self.area @ self.weights)
        return np.divide(load, area, out=np.zeros_like(load), where=area > 0.0)


def contact_pressure(problem: Problem, u: np.ndarray, drive: Drive) -> dict[str, np.ndarray]:
    """Return the field "contact_pressure" (n,) [Pa] of all obstacles together, none where there are none."""
    each = [item.pressure(u, drive) for item in problem.items if isinstance(item, Contact)]
    return {"contact_pressure": np.sum(each, axis=0)} if each else {}


def contacts(scene: Scene, assembly: Assembly) -> tuple[Contact, ...]:
    """Return the contact of a lattice with each of the scene's obstacles. Raises BadInput for one too
    thin."""
    return tuple(Contact(scene, assembly, name, each) for name, each in obstacles_by_name(scene).items())
