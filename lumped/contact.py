"""Contact of the sheet with one rigid obstacle: a penalty on the mid-surface, offset by half the thickness.

With its distance φ from the obstacle (`sheetbench.scenes.meaning.distances`) and depth d = ⟨h/2 + δ₀ − φ⟩ a
point of area A has

    energy A ψ(d),   force A p n,  p = ψ',   tangent A (p' n nᵀ − p ∇n);   ψ = ½ k d² at rest,  k = E/h.

On a plane each cell has a point at each of its corners, a column of masses. On a sphere or cylinder these
sample the contact to first order only: each side l of a cell is in s parts, s = max(2, ⌈2 l/R⌉), with l as
far as it is across a cylinder's axis, and points are at their middles; at their ends, masses among them, of a
sheet that rests on the obstacle, or nothing would hold it at the start. In motion areas are as much larger
or smaller as masses are than their tributary ones, so that a sheet which lands flat stays flat, k is
0.065 ρ h ω_max² at most, and the law is rounded over δ = 0.3 h: ψ = k d³/6δ up to δ, beyond k (d²/2 − δ d/2 +
δ²/6). Conserving midpoint steps have the mean force −A (Δψ/Δφ) n̄ (Gonzalez, 1996). `docs/contact.md` has the
reasons, and what energy they take.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lumped.assembly import Assembly
from lumped.items import LatticeItem, Placed, Since
from lumped.masses import over_tributary
from sheetbench.answers.contact import ContactState
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, free_rigid_motions
from sheetbench.scenes.meaning.composition import constants_at
from sheetbench.scenes.meaning.distances import Near, dyad, near, projector
from sheetbench.scenes.objects.obstacles import TOUCH, AnyObstacle

THINNEST = 1 / 16  # radius of an obstacle over a cell's side, which then has 32 points
MOVING = 0.065  # of ω_max², that contact in motion adds at most
ROUNDED = 0.3  # δ of the thickness, in motion
SAME_DEPTH = 1e-7  # of the thickness, by which depths differ of which the mean force is that of the mean
Pressed = tuple[np.ndarray, np.ndarray, np.ndarray]  # A ψ [J], A p [N] and A p' [N/m] (m, p)


def points_of_cells(sides: np.ndarray, radius: float, ends: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return weights (p, 4) of a cell's corners in turn and shares (p,) of its area, of points at the middles
    of the parts of its sides (2,) [m] or, on a plane always, at their ends."""
    rules, fewest = [], 2 if np.isfinite(radius) else 1
    ends |= fewest == 1
    for parts in np.maximum(fewest, np.ceil(2.0 * sides / radius)).astype(int):
        at = (np.arange(parts + ends) + 0.5 * (not ends)) / parts
        shares = np.full(len(at), 1.0 / parts)
        shares[[0, -1]] /= 1 + ends
        rules.append((np.stack([1.0 - at, at], axis=1), shares))
    (along_x, width), (along_y, height) = rules
    return np.kron(along_y, along_x)[:, [0, 1, 3, 2]], np.kron(height, width)


class Contact(LatticeItem):
    """Contact of a lattice with an obstacle: nodes (m, q) of cells, weights (p, q) of their points. Raises
    BadInput for one too thin."""

    def __init__(self, scene: Scene, assembly: Assembly, name: str, obstacle: AnyObstacle):
        self.name, self.obstacle = name, obstacle
        self.place, self.velocity = obstacle.place, obstacle.velocity
        self.moves = obstacle.motion is not None
        self.resists = obstacle.friction > 0.0 or obstacle.contact_damping > 0.0
        lattice = assembly.lattice
        across = np.linalg.norm(projector(obstacle)[:2], axis=1)  # how much of a side is across its axis
        sides = across * [line.widths.max() for line in lattice.lines]
        if obstacle.radius < THINNEST * sides.max():
            thin = f"{name}.radius = {obstacle.radius:g}: too thin for cells of {1e3 * sides.max():.3g} mm"
            raise BadInput(f"{thin}, which would step over it; {THINNEST:g} of that or more, or a finer grid")
        weights, shares = points_of_cells(sides, obstacle.radius, bool(free_rigid_motions(scene)))
        self.weights = np.repeat(weights, lattice.grid[2], axis=1) / lattice.grid[2]
        self.nodes = lattice.mid_cells.reshape(-1, self.weights.shape[1])
        self.area = np.outer(lattice.cell_areas[lattice.cell_areas > 0.0], shares)
        inert = over_tributary(scene, lattice, assembly.inertia, assembly.cells)
        self._inert = np.einsum("pq,mq->mp", self.weights, inert[self.nodes])
        self._rest = lattice.positions[self.nodes]
        constants = constants_at(scene, (self.weights @ self._rest)[..., :2]).arrays(self.area.shape)
        self.thickness, self.full = constants.thickness, constants.stretching / constants.thickness**2
        self.offset = (0.5 + TOUCH) * self.thickness
        self.share, self.rounded, self._masses = 1.0, 0.0, lattice.mass_count
        self.slots, self._eps = assembly.pattern.among(self.nodes), assembly.rounding

    def _law(self, depth: np.ndarray, of: Any = ...) -> Pressed:
        """Return A ψ [J], A p [N] and A p' [N/m] of patches `of` at depths (m, p) [m]."""
        d, stiffness = np.maximum(depth, 0.0), self.share * self.full[of] * self.area[of]
        over = max(self.rounded, 1e-100) * self.thickness[of]
        curved, sure = np.minimum(d, over), np.maximum(d - over, 0.0)
        energy = curved**3 / (6.0 * over) + 0.5 * sure * (sure + over)
        return stiffness * energy, stiffness * (0.5 * curved**2 / over + sure), stiffness * curved / over

    def near(self, at: Placed, of: Any = ...) -> Near:
        """Return where points (m, p) of patches are."""
        places = self.weights @ (self._rest[of] + at[0][self.nodes[of]])
        return near(self.obstacle, places, self.offset[of], at[1])

    def _pressed(self, at: Placed, since: Since = None) -> tuple[Any, Near, Pressed]:
        """Return which patches may touch, where their points are and how they are pressed; since: what a step
        from there has in the mean."""
        if since is not None:
            before, after = self.near(since), self.near(at)
            (had, _, _), (has, last, _) = self._law(before.depth), self._law(after.depth)
            far = np.abs(after.depth - before.depth) > SAME_DEPTH * self.thickness
            sunk = np.where(far, after.depth - before.depth, 1.0)
            _, load, slope = self._law(0.5 * (before.depth + after.depth))
            load = np.where(far, (has - had) / sunk, load)
            return ..., after.mean(before), (has, load, np.where(far, (last - load) / sunk, 0.5 * slope))
        places = self._rest + at[0][self.nodes]
        middle = places.mean(axis=1, keepdims=True)  # no point is farther from it than a mass
        reach = np.sqrt(((places - middle) ** 2).sum(axis=2).max(axis=1)) + 1.01 * self.offset.max(axis=1)
        of = np.flatnonzero(near(self.obstacle, middle[:, 0], reach, at[1]).depth > 0.0)
        found = self.near(at, of)
        return of, found, self._law(found.depth, of)

    def _spread(self, values: np.ndarray, out: np.ndarray, of: Any = ...) -> np.ndarray:
        """Add what points (m, p, …) of patches share to the masses' (n, …), and return that."""
        np.add.at(out, self.nodes[of], np.einsum("pq,mp...->mq...", self.weights, values))
        return out

    def _spread_blocks(self, points: np.ndarray, blocks: np.ndarray, of: Any) -> None:
        """Add derivatives at points (m, p, 3, 3) of patches to the pattern's blocks."""
        touched = points.any(axis=(1, 2, 3))
        of_masses = np.einsum("pa,pb,mpij->mabij", self.weights, self.weights, points[touched], optimize=True)
        np.add.at(blocks, self.slots[of][touched], of_masses)

    def add_force(self, at: Placed, force: np.ndarray, since: Since = None) -> float:
        of, found, (energy, load, _) = self._pressed(at, since)
        self._spread(-load[..., None] * found.normal, force, of)
        return float(energy.sum())

    def add_tangent(
        self, at: Placed, scale: float, blocks: np.ndarray, definite: bool = False, since: Since = None
    ) -> None:
        of, found, (_, load, slope) = self._pressed(at, since)
        points = (scale * slope)[..., None, None] * dyad(found.normal)
        if not definite:
            points -= (scale * load)[..., None, None] * found.curvature
        self._spread_blocks(points, blocks, of)

    def _resisted(self, at: Placed, v: np.ndarray) -> tuple[Any, np.ndarray, tuple[np.ndarray, np.ndarray]]:
        """Return patches that may touch, how points move past the obstacle (m, p, 3) [m/s], and forces (m, p,
        3) [N] of dashpot and friction with their derivatives by that (m, p, 3, 3)."""
        of, found, (_, load, _) = self._pressed(at)
        speed = self.weights @ (v[self.nodes[of]] - self.obstacle.velocity(at[1].time))
        return of, speed, found.resistance(load, speed)

    def add_resistance(self, at: Placed, v: np.ndarray, force: np.ndarray) -> float:
        if not self.resists:
            return 0.0
        of, speed, (pull, _) = self._resisted(at, v)
        self._spread(-pull, force, of)
        return -float((pull * speed).sum())

    def add_resistance_tangent(self, at: Placed, v: np.ndarray, scale: float, blocks: np.ndarray) -> None:
        if self.resists:
            of, _, (_, by_speed) = self._resisted(at, v)
            self._spread_blocks(-scale * by_speed, blocks, of)

    def stiffest(self, mass: np.ndarray) -> float:
        return float((self._spread(self.area * self.share * self.full, np.zeros(self._masses)) / mass).max())

    def move_freely(self, mass: np.ndarray, squared: float) -> None:
        self.rounded, self.area = ROUNDED, self.area * self._inert
        self.share = min(1.0, MOVING * squared / self.stiffest(mass) * self.share)

    def rounding(self) -> float:
        largest = float(np.abs(self._rest).max())
        return self._eps * largest * float(np.linalg.norm(self.area * self.share * self.full))

    def report(self, at: Placed) -> tuple[ContactState, np.ndarray]:
        """Return what there is to say of it at an equilibrium, and its pressure (n,) [Pa] at the masses."""
        depth = self.near(at).depth
        area, load = (self._spread(one, np.zeros(self._masses)) for one in (self.area, self._law(depth)[1]))
        pressure = np.divide(load, area, out=np.zeros_like(load), where=area > 0.0)
        return ContactState.of(depth / self.thickness, self.area), pressure

    def table(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return masses (t, q) around its points and their weights (t, q); and (t, 10) the obstacle's place,
        direction and radius, 0 of a plane [m], a point's area [m²], offset [m] and stiffness [N/m³]: with φ
        its distance a point has the energy ½ stiffness area ⟨offset − φ⟩²."""
        body, (cells, points) = self.obstacle, self.area.shape
        place = np.nan_to_num([*body.place(), *body.direction, body.radius], posinf=0.0)
        values = [*np.broadcast_to(place, (cells, points, 7)).T, self.area.T, self.offset.T, self.full.T]
        masses, weights = np.repeat(self.nodes, points, axis=0), np.tile(self.weights, (cells, 1))
        return masses, weights, np.stack(values).T.reshape(-1, 10)
