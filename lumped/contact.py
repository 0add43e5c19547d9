"""Contact of the sheet with one rigid obstacle: a penalty on the mid-surface, offset by half the thickness.

A point of the mid-surface has the depth δ, which is o = h/2 + δ₀ minus its distance from the obstacle
(`sheetbench.scenes.meaning.distances`); contact has the

    energy ∫ ψ(δ) dA,   force ∫ p n dA,  p = ψ',   tangent ∫ p' n nᵀ − p ∂n/∂x dA over the patch {δ > 0}

On a plane under a sheet that is flat when nothing acts on it δ is linear between corners of cells: its
deepest points are corners, columns of masses, and each has a quarter of a cell's area. Else the patch may be
anywhere in a cell and much smaller than it: the surface is curved at rest (`cell_surface`), δ is known at 3 ×
3 points of each part of a cell, parts no longer than R/3, and biquadratic between them, and the integral runs
over the patch (`patch`), whose size and place follow the sheet: the patch of a cradle slides. At rest ψ = ½ k
δ² with k = E/h, of patches STIFFER times as much: a small one leaves less than the thickness to give. Motion
has k = 0.065 ρ h ω_max² at most, cells straight between masses, in parts up to R/2, and a law rounded over δ₁
= 0.3 h: ψ = k (⟨δ⟩³ − ⟨δ − δ₁⟩³)/6δ₁; areas are as much larger or smaller as masses are than their tributary
ones, so that a sheet which lands flat stays flat. Conserving midpoint steps have the mean force of Gonzalez
(1996), from mean n̄ and, of depths d of a part, p(d̄) + (Δψ − p(d̄)·Δd) Δd/|Δd|². `docs/contact.md` has the
reasons, and what energy they take.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lumped.actuators import Drive
from lumped.assembly import Assembly
from lumped.cell_surface import CellSurface, shapes
from lumped.masses import over_tributary
from lumped.patch import integrate
from sheetbench.answers.contact import ContactState
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.composition import constants_at
from sheetbench.scenes.meaning.distances import ContactPoints, near, projector
from sheetbench.scenes.objects.obstacles import TOUCH, AnyObstacle, Plane

THINNEST = 1 / 16  # radius of an obstacle over a cell's side, which then has 48 parts
STIFFER = 100.0  # of E/h, where the patch may be small
MOVING = 0.065  # of ω_max², that contact in motion adds at most
ROUNDED = 0.3  # δ₁ of the thickness, in motion
NEARLY = 1e-6  # of a part, over which lengths may be, so that sides of round ratios have parts that stay
SAME_DEPTH = 1e-7  # of the thickness, by which depths differ of which the mean force is that of the mean
Deformed = tuple[np.ndarray, Drive]  # displacement (n, 3) [m] of the masses, and load factor or time
Since = Deformed | None  # start of the step over which a mean is returned
TO_CORNERS = np.kron(*2 * [np.array([[1, 0, 0], [0.5, 0, 0.5], [0, 0, 1]])])  # shares of nine points, (9, 9)


# cells that may touch, vectors of their sides (`CellSurface.vectors`), their points (m, p) beside the
# obstacle, and of their groups of n points (m, t): energies [J], loads (…, n) [N], derivatives by depths
# (…, n, n) [N/m]
Pressed = tuple[Any, np.ndarray, ContactPoints, np.ndarray, np.ndarray, np.ndarray]


def parts_of_cells(sides: np.ndarray, longest: float, of: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return coordinates r, s (p,) of points in a cell, and the numbers (t, 9) of the points of each part.
    The cell, with sides (2,) [m], is divided into equal parts no longer than `longest` [m], their number
    along each side a multiple of `of`."""
    n, m = of * np.maximum(1, np.ceil(sides / longest / of - NEARLY)).astype(int)
    lines = np.linspace(0.0, 1.0, 2 * m + 1), np.linspace(0.0, 1.0, 2 * n + 1)
    s, r = (each.ravel() for each in np.meshgrid(*lines, indexing="ij"))
    number = np.arange(len(r)).reshape(2 * m + 1, 2 * n + 1)
    windows = np.lib.stride_tricks.sliding_window_view(number, (3, 3))[::2, ::2]
    return r, s, windows.reshape(-1, 9)


class Contact:
    """Contact of a lattice with an obstacle. nodes: (m, q) masses of the cells; basis: (p, 12) shape
    functions at a cell's points; weights: (p, q) of its masses there, on the bilinear surface; groups: (t, n)
    points of each part, nine or one corner; resists: whether contact dissipates energy. Forces and velocities
    are (n, 3) [N], [m/s]; forces are internal, the gradient of the energy. Raises BadInput for an obstacle
    too thin."""

    def __init__(self, scene: Scene, assembly: Assembly, name: str, obstacle: AnyObstacle):
        self.name, self.obstacle = name, obstacle
        self.resists = obstacle.friction > 0.0 or obstacle.contact_damping > 0.0
        lattice = assembly.lattice
        across = np.linalg.norm(projector(obstacle)[:2], axis=1)  # how much of a side is across its axis
        sides = across * [line.widths.max() for line in lattice.lines]
        if obstacle.radius < THINNEST * sides.max():
            thin = f"{name}.radius = {obstacle.radius:g}: too thin for cells of {1e3 * sides.max():.3g} mm"
            instead = f"take {THINNEST:g} of a cell or more, or a finer grid"
            raise BadInput(f"{thin}, which would miss it; {instead}")
        self._scene, self._lattice, self._sides = scene, lattice, sides
        self.surface = CellSurface(lattice.grid, lattice.layer_distance)
        self.nodes = lattice.mid_cells.reshape(-1, 4 * lattice.grid[2])
        self._inert = over_tributary(scene, lattice, assembly.inertia, assembly.cells)
        self._rest = lattice.positions[self.nodes]
        self.share, self.rounded, self._masses = 1.0, 0.0, lattice.mass_count
        self.slots, self._eps = assembly.pattern.among(self.nodes), assembly.rounding
        flat = not (scene.natural_by or scene.actuators)
        self.divide(at_corners=isinstance(obstacle, Plane) and flat, bent=True)

    def divide(self, at_corners: bool, bent: bool = False) -> None:
        """Divide the cells into parts with points of contact: on the curved surface if `bent`, else on the
        bilinear one; with `at_corners` at the cells' corners alone."""
        self.at_corners, self.bent = at_corners, bent and not at_corners
        longest = self.obstacle.radius / (3.0 if self.bent else 2.0)
        r, s, self.groups = parts_of_cells(self._sides, longest, 2 if self.bent else 1)
        corners = self.groups[:, [0, 2, 6, 8]].ravel()
        if at_corners:
            on, corners = np.unique(corners, return_inverse=True)
            r, s, self.groups = r[on], s[on], np.arange(len(on))[:, None]
        self.basis = shapes(r, s)
        self.weights = self.basis[:, :4] @ self.surface.corners
        plan, shape = (self.weights @ self._rest)[..., :2], (len(self.nodes), len(r))
        constants = constants_at(self._scene, plan).arrays(shape)
        self.thickness, stiffer = constants.thickness, 1.0 if at_corners else STIFFER
        self.full = stiffer * constants.stretching / self.thickness**2
        self.offset, areas = (0.5 + TOUCH) * self.thickness, self._lattice.cell_areas
        self.area = np.outer(areas[areas > 0.0], np.bincount(corners, minlength=len(r))) / len(corners)
        by_part = self.area.sum(axis=1)[:, None, None] / (4 * len(self.groups))  # its dr ds, of −1 to 1
        self.sizes = self.area[:, self.groups] if at_corners else by_part
        self.shares = self.basis if self.bent else self.weights

    def _surface(self, at: Deformed, of: Any) -> tuple[np.ndarray, ContactPoints]:
        vectors, sides = self._rest[of] + at[0][self.nodes[of]], np.empty((3, 0))
        if self.bent:
            vectors, sides = self.surface.vectors(vectors)
        return sides, near(self.obstacle, self.shares @ vectors, self.offset[of], at[1])

    def near(self, at: Deformed) -> ContactPoints:
        """Return the positions and depths of the cells' points (m, p) relative to the obstacle."""
        return self._surface(at, ...)[1]

    def _law(self, depth: np.ndarray, of: Any, tangent: bool = False) -> tuple[np.ndarray, ...]:
        """Return energies, loads and their derivatives (see `Pressed`), and the largest depth of each part,
        from depths (m, t, n)."""
        over, n = self.rounded * self.thickness[of][:, self.groups[:, :1]], depth.shape[2]
        k = (self.share * self.full[of])[:, self.groups] * self.sizes[of]

        def integrals(less: Any, k: np.ndarray, power: int) -> tuple[np.ndarray, ...]:
            rows = (np.ascontiguousarray(each).reshape(-1, n) for each in (depth - less, k))
            found = integrate(*rows, power, tangent)
            return tuple(each.reshape(*depth.shape[:2], *each.shape[1:]) for each in found)

        if not self.rounded:
            return integrals(0.0, k, 2)
        (*full, deepest), (*less, _) = integrals(0.0, k / over, 3), integrals(over, k / over, 3)
        return *(a - b for a, b in zip(full, less, strict=True)), deepest

    def _pressed(self, at: Deformed, since: Since = None, tangent: bool = False) -> Pressed:
        """Return the contact state of cells that may touch; with `since` the mean state of the step from
        there."""
        if since is None:
            places = self._rest + at[0][self.nodes]
            middle = places.mean(axis=1, keepdims=True)
            farthest = 1.3 * np.sqrt(((places - middle) ** 2).sum(axis=2).max(axis=1))  # with the bubbles
            reach = farthest + 1.01 * self.offset.max(axis=1)
            of = np.flatnonzero(near(self.obstacle, middle[:, 0], reach, at[1]).depth > 0.0)
            sides, found = self._surface(at, of)
            energy, load, slope, _ = self._law(found.penetration[:, self.groups], of, tangent)
            return of, sides, found, energy, load, slope
        before, (sides, after) = self.near(since), self._surface(at, ...)
        start, end = before.penetration[:, self.groups], after.penetration[:, self.groups]
        (had, *_), (has, last, *_) = self._law(start, ...), self._law(end, ...)
        _, load, slope, _ = self._law(0.5 * (start + end), ..., True)
        sunk, half = end - start, 0.5 * slope
        square = (sunk * sunk).sum(axis=2)[..., None]
        far = square > (SAME_DEPTH * self.thickness[:, :1, None]) ** 2
        sunk, square = sunk * far, np.where(far, square, 1.0)
        more = far * ((has - had)[..., None] - (load * sunk).sum(axis=2)[..., None]) / square
        by = last - load - (half @ sunk[..., None])[..., 0] - 2.0 * more * sunk
        rank = sunk[..., :, None] * (by / square)[..., None, :]
        slope = half + more[..., None] * np.eye(half.shape[-1]) + 0.5 * (rank + rank.swapaxes(-1, -2))
        return ..., sides, after.mean(before), has, load + more * sunk, slope

    def _at_points(self, load: np.ndarray) -> np.ndarray:
        """Add up the loads of groups (m, t, n) at the cells' points (m, p)."""
        out = np.zeros((len(load), len(self.basis)))
        np.add.at(out, (np.arange(len(load))[:, None, None], self.groups), load)
        return out

    def _positive(self, load: np.ndarray) -> np.ndarray:
        """Return the loads of groups distributed over the corners of parts, where all are compressive."""
        return self._at_points(load if self.at_corners else load @ TO_CORNERS)

    def add_force(self, at: Deformed, force: np.ndarray, since: Since = None) -> float:
        """Add the internal force, or, with the start `since` of a step, the mean force whose work over the
        step equals the change of energy; return the energy [J]."""
        of, sides, near, energy, load, _ = self._pressed(at, since)
        pull = self.shares.T @ (self._at_points(load)[..., None] * near.slope)
        if self.bent:
            pull = np.einsum("mqi,mqiaj->maj", pull, self.surface.first(sides), optimize=True)
        np.add.at(force, self.nodes[of], -pull)
        return float(energy.sum())

    def add_tangent(
        self, at: Deformed, scale: float, blocks: np.ndarray, definite: bool = False, since: Since = None
    ) -> None:
        """Add scale × the tangent to the pattern's blocks (b, 3, 3) [N/m]; for the mean force of a step, the
        symmetric part of its derivative by the displacement at the end. definite: leave out parts that could
        make the tangent indefinite."""
        of, sides, near, _, load, slope = self._pressed(at, since, True)
        cell, group = np.nonzero(load.any(axis=2))
        on, back = np.unique(cell, return_inverse=True)
        if not len(on):
            return
        points, (size, shares) = self.groups[group], (self.groups.shape[1], self.shares)
        change = shares[points][..., None] * near.slope[cell[:, None], points][:, :, None]
        change = change.reshape(len(cell), size, -1)
        by = np.zeros((len(on), *2 * change.shape[2:]))
        np.add.at(by, back, change.swapaxes(1, 2) @ slope[cell, group] @ change)
        loads = self._at_points(load[on]) * (not definite)
        bent = loads[..., None] * near.curvature[on]
        both = np.einsum("mpj,pa,pb->mabj", bent, shares, shares, optimize=True)
        by -= (both[:, :, None] * projector(self.obstacle)[:, None]).reshape(by.shape)
        if self.bent:
            first = self.surface.first(sides[:, on]).reshape(len(on), 36, -1)
            pull = np.einsum("mp,pq,mpi->mqi", loads, self.basis[:, 4:], near.slope[on])
            second = self.surface.second(sides[:, on], pull)
            by = first.swapaxes(1, 2) @ by @ first - second.reshape(len(on), first.shape[2], -1)
        size = self.nodes.shape[1]
        of_masses = by.reshape(-1, size, 3, size, 3).transpose(0, 1, 3, 2, 4)
        np.add.at(blocks, self.slots[of][on], scale * of_masses)

    def _resisted(self, at: Deformed, v: np.ndarray) -> tuple[Any, np.ndarray, tuple[np.ndarray, np.ndarray]]:
        """Return the cells that may touch, their points' velocities relative to the obstacle (m, p, 3) [m/s],
        and dashpot and friction forces (m, p, 3) [N] with their derivatives by velocity (m, p, 3, 3)."""
        of, _, near, _, load, _ = self._pressed(at)
        speed = self.weights @ (v[self.nodes[of]] - self.obstacle.velocity(at[1].time))
        return of, speed, near.resistance(self._positive(load), speed)

    def add_resistance(self, at: Deformed, v: np.ndarray, force: np.ndarray) -> float:
        """Add the dashpot and friction forces; return the power that they dissipate [W]."""
        if not self.resists:
            return 0.0
        of, speed, (pull, _) = self._resisted(at, v)
        np.add.at(force, self.nodes[of], -np.einsum("pq,mpi->mqi", self.weights, pull))
        return -float((pull * speed).sum())

    def add_resistance_tangent(self, at: Deformed, v: np.ndarray, scale: float, blocks: np.ndarray) -> None:
        """Add scale × the derivative of the dashpot and friction forces by the velocity [N·s/m]."""
        if self.resists:
            of, _, (_, by_speed) = self._resisted(at, v)
            touched = by_speed.any(axis=(1, 2, 3))
            sides = self.weights, self.weights, by_speed[touched]
            of_masses = np.einsum("pa,pb,mpij->mabij", *sides, optimize=True)
            np.add.at(blocks, self.slots[of][touched], -scale * of_masses)

    def exerted(self, at: Deformed, v: np.ndarray | None = None) -> np.ndarray:
        """Return the obstacle's forces on the masses (n, 3) [N]; v: velocity in motion."""
        force = np.zeros_like(at[0])
        self.add_force(at, force)
        if v is not None:
            self.add_resistance(at, v, force)
        return -force

    def _of_masses(self, points: np.ndarray) -> np.ndarray:
        """Distribute values at points (m, p) over the masses (n,) by the points' weights."""
        return np.bincount(self.nodes.ravel(), (points @ self.weights).ravel(), minlength=self._masses)

    def stiffest(self, mass: np.ndarray) -> float:
        """Return a bound of the increase of squared frequencies ω² [1/s²] by contact; mass: (n,) [kg]."""
        present = mass > 0.0
        return float((self._of_masses(self.area * self.share * self.full)[present] / mass[present]).max())

    def set_motion_penalty(self, mass: np.ndarray, squared: float) -> None:
        """Set the penalty for a motion; squared: the springs' highest ω² [1/s²], which limits its
        stiffness."""
        self.divide(at_corners=isinstance(self.obstacle, Plane))
        self.full, self.rounded = self.full * (self._inert[self.nodes] @ self.weights.T), ROUNDED
        self.share = min(1.0, MOVING * squared / self.stiffest(mass) * self.share)

    def rounding(self, at: Deformed) -> float:
        """Return the norm [N] of the contact forces' error caused by rounding of displacements."""
        touched = self._pressed(at, tangent=True)[-1].sum(axis=(2, 3))
        return self._eps * float(np.abs(self._rest).max() * np.linalg.norm(touched))

    def report(self, at: Deformed) -> tuple[ContactState, np.ndarray]:
        """Return the state of contact at an equilibrium and the pressure (n,) [Pa] at the masses."""
        found = self.near(at)
        _, load, slope, deepest = self._law(found.penetration[:, self.groups], ..., True)
        first, area = self.groups[:, 0], self._of_masses(self.area)
        touched = slope.sum(axis=(2, 3)) / (self.share * self.full[:, first])
        pressed = self._of_masses(self._positive(load))
        pressure = np.divide(pressed, area, out=np.zeros_like(area), where=area > 0.0)
        return ContactState.of(deepest / self.thickness[:, first], touched, load), pressure

    def table(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return a table of the points in contact: masses (t, q) around each and their weights (t, q); and
        (t, 10) the obstacle's position [m], direction and radius [m], 0 for a plane, and the point's area
        [m²], offset [m] and stiffness [N/m³]. For contact at corners, a point of depth δ has the energy ½
        stiffness area ⟨δ⟩²."""
        body, cells = self.obstacle, len(self.nodes)
        at = self.groups[:, 0]
        place = np.nan_to_num([*body.place(), *body.direction, body.radius], posinf=0.0)
        of_points = [each[:, at].T for each in (self.area, self.offset, self.full)]
        values = [*np.broadcast_to(place, (cells, len(at), 7)).T, *of_points]
        masses, weights = np.repeat(self.nodes, len(at), axis=0), np.tile(self.weights[at], (cells, 1))
        return masses, weights, np.stack(values).T.reshape(-1, 10)
