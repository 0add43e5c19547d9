"""All actuators of a scene, bound to a lattice: their rows follow those of the masses in the displacement.

A mass of an edge moved rigidly follows the motion, whatever else acts on it: scenes refuse what the motion
would contradict; where two motions share a corner they share its force. Any other mass that a support holds,
in whichever component, stays with its support; a corner at which a chain has its base is that chain's. Two
chains on neighbouring edges have the corner in common (`lumped.actuators.corners`). A chain that ends at a
corner whose director a support or another chain's base holds is held there too, unless the support moves over
time: with an end that moves so the integrators do not keep the balance of energy. There, and beside an edge
moved rigidly, the sheet alone holds it. Chains on one edge are one actuator model.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from lumped.actuators.actuator import Acting, Drive, RigidMotion
from lumped.actuators.chain import BoundChain
from lumped.actuators.corners import SharedCorner, Tie, based_beside, held_ends, shared_corners, shared_ends
from lumped.coverage import held_columns, reached_parts
from lumped.lattice import Lattice
from sheetbench.scenes import EDGES, Scene


class Coupling:
    """The actuators with the place of each one's rows; all arrays over masses and rows together."""

    def __init__(self, scene: Scene, lattice: Lattice):
        self.masses = lattice.mass_count
        self._positions = lattice.positions
        motions = _motions(scene, lattice)
        self.moved = np.zeros(lattice.mass_count, dtype=bool)  # masses of edges moved rigidly
        for motion in motions:
            self.moved[motion.masses] = True
        chains, shared = _chains(scene, lattice, self.moved)
        ends = np.cumsum([lattice.mass_count, *(chain.rows for chain in chains)])
        places = [slice(int(a), int(b)) for a, b in pairwise(ends)]
        self._motions: tuple[RigidMotion, ...] = motions
        self._bodies: list[tuple[BoundChain, slice]] = list(zip(chains, places, strict=True))
        begin = {chain.edge: (chain, place.start) for chain, place in zip(chains, places, strict=True)}
        self.ties = [_tie(corner, *(begin[edge] for edge in corner.edges)) for corner in shared]
        bases = {edge: next(iter(here.values())).held_as for edge, here in scene.chains().items()}
        self._held_by = {  # number and end of a chain that another's base holds → the base
            (number, end): bases[beside]
            for number, chain in enumerate(chains)
            for end in chain.corners
            if (beside := based_beside(scene, chain.edge, end))
        }
        by_edge: dict[str, tuple[BoundChain | RigidMotion, slice]] = {
            motion.edge: (motion, slice(0)) for motion in motions
        }
        by_edge |= {body.edge: (body, place) for body, place in self._bodies}
        self._all = [by_edge[edge] for edge in dict.fromkeys(str(a.edge) for a in scene.actuators)]
        self._layers = {edge: lattice.edge_columns(edge) for edge in EDGES}
        self.size = int(ends[-1])
        self.multipliers = sum(chain.multipliers for chain in chains)
        self.algebraic = np.zeros((self.size, 3), dtype=bool)  # components that are multipliers
        for body, place in self._bodies:
            first = body.rows - -(-body.multipliers // 3)
            self.algebraic[place][first:] = body.free[first:]

    @property
    def bodies(self) -> tuple[BoundChain, ...]:
        """The actuators with rows of their own, in the order of these."""
        return tuple(body for body, _ in self._bodies)

    @property
    def free(self) -> np.ndarray:
        """Components of the bodies' rows that can move, (rows, 3) bool."""
        return np.concatenate([np.empty((0, 3), bool), *(body.free for body in self.bodies)])

    def pairs(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows that act on each other, as ordered pairs of numbers after the masses."""
        found = [np.argwhere(a.pairs) + place.start for a, place in self._bodies]
        rows, columns = np.concatenate([np.empty((0, 2), int), *found]).T
        return rows, columns

    def bindings(self) -> list[tuple[np.ndarray, np.ndarray, int]]:
        """For every body: bound masses (m,), binding (m, rows), number of its first row."""
        return [(a.masses, a.binding, place.start) for a, place in self._bodies]

    def carried(self) -> np.ndarray:
        """Forces (size,) [N] on the actuators' rows whose rounding the residual cannot fall below."""
        forces = np.zeros(self.size)
        for body, place in self._bodies:
            forces[place] = body.carried
        return forces

    def weight(self, acceleration: np.ndarray) -> np.ndarray:
        """Dead forces (rows, 3) [N] of a uniform acceleration on the actuators' rows."""
        return np.concatenate([np.empty((0, 3)), *(a.weight(acceleration) for a in self.bodies)])

    def axes(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Of every edge with chains: the rows of the points where their segments end, (p,), and the points'
        rest places (p, 3) [m]; of several chains on an edge the mean of their axes."""
        return {
            body.edge: (place.start + np.arange(len(points)), points)
            for body, place in self._bodies
            if len(points := body.axis)
        }

    def corners(self) -> list[tuple[BoundChain, slice, int, np.ndarray]]:
        """Ends of bodies held at corners: body, its place, end (0 or 1), the corner's masses (layers,)."""
        return [
            (body, place, end, self._layers[body.edge][-end])
            for body, place in self._bodies
            for end in body.corners
        ]

    def follow(self, placed: np.ndarray) -> None:
        """Put chains' ends and what is bound to them where their corners are put, in `placed` (size, 3)."""
        moved: dict[int, np.ndarray] = {}
        for chain, place, end, column in self.corners():
            y = chain.place_corner(end, self._positions[column, 2], placed[column])
            moved[place.start] = moved.get(place.start, 0.0) + y
            placed[place] = moved[place.start]
            placed[chain.masses] = chain.binding @ moved[place.start]

    def driven(self, drive: Drive) -> np.ndarray:
        """Prescribed displacement (size, 3) [m] of the masses of moved edges."""
        moved = np.zeros((self.size, 3))
        for motion in self._motions:
            moved[motion.masses] = motion.driven(drive)
        return moved

    def driven_velocity(self, time: float) -> np.ndarray:
        """The velocity (size, 3) [m/s] of what is prescribed, from a time [s] on."""
        velocity = np.zeros((self.size, 3))
        for motion in self._motions:
            velocity[motion.masses] = motion.velocity(time)
        return velocity

    def add_force(self, u: np.ndarray, drive: Drive, force: np.ndarray) -> float:
        """Add the actuators' internal force to `force` (size, 3) [N]; their energy [J]."""
        energy = 0.0
        for body, place in self._bodies:
            stored, gradient = body.force(u[place], drive)
            energy += stored
            force[place] += gradient
        return energy

    def add_average_force(self, start: np.ndarray, end: np.ndarray, drive: Drive, force: np.ndarray) -> None:
        """Add the energy-conserving average of the internal force between two displacements."""
        for body, place in self._bodies:
            force[place] += body.average_force(start[place], end[place], drive)

    def add_tangent(
        self,
        u: np.ndarray,
        drive: Drive,
        slots: np.ndarray,
        blocks: np.ndarray,
        scale: float = 1.0,
        damping: float = 0.0,
    ) -> None:
        """Add scale × the tangent and damping × the derivative of the damping force by the velocity to the
        3×3 blocks at `slots`, one for every pair of `pairs`."""
        parts = [np.empty((0, 3, 3))]
        for body, place in self._bodies:
            dense = scale * body.tangent(u[place], drive)
            if damping and body.damped:
                dense += damping * body.damping_tangent(u[place])
            rows, columns = np.nonzero(body.pairs)
            parts.append(dense[rows, :, columns, :])
        np.add.at(blocks, slots, np.concatenate(parts))

    def constraint_gradient(self, u: np.ndarray) -> np.ndarray:
        """Derivatives (multipliers, rows, 3) of all constraints by the rows after the masses."""
        out = np.zeros((self.multipliers, self.size - self.masses, 3))
        first = 0
        for body, place in self._bodies:
            rows = slice(place.start - self.masses, place.stop - self.masses)
            out[first : first + body.multipliers, rows] = body.constraint_gradient(u[place])
            first += body.multipliers
        return out

    def mass_blocks(self) -> np.ndarray:
        """Mass of every pair of `pairs` [kg]."""
        return np.concatenate([np.empty(0), *(a.mass[a.pairs] for a in self.bodies)])

    def command_work(self, u: np.ndarray, drive: Drive, later: Drive) -> float:
        """Work [J] of the commands going from one drive to the next at displacement u."""
        return sum(b.energy(u[at], later) - b.energy(u[at], drive) for b, at in self._bodies)

    def add_damping_force(self, u: np.ndarray, v: np.ndarray, force: np.ndarray) -> float:
        """Add the damping force to `force` (size, 3) [N]; the power taken [W]."""
        power = 0.0
        for body, place in self._bodies:
            taken, resisting = body.damping_force(u[place], v[place])
            power += taken
            force[place] += resisting
        return power

    def reactions(self, exerted: np.ndarray) -> dict[str, np.ndarray]:
        """Force (3,) [N] of every prescribed motion and held base, by its name among a solution's reactions,
        from what holds masses and rows, (size, 3) [N]."""
        found: dict[str, np.ndarray] = {}
        for actuator, acting in self._acting(np.zeros_like(exerted), exerted):
            found |= actuator.reactions(acting)
        for (chain, end), base in self._held_by.items():
            body, place = self._bodies[chain]
            on_rows = exerted[place] + body.binding.T @ exerted[body.masses]
            found[base] = found[base] + body.corner_force(end, on_rows)
        return found

    def held_moment(self, u: np.ndarray, exerted: np.ndarray, drive: Drive) -> np.ndarray:
        """Moment (3,) [N·m] about the origin of what holds the actuators, corners of chains among it, from
        what holds masses and rows, (size, 3) [N]."""
        total = np.zeros(3)
        for actuator, acting in self._acting(u, exerted):
            total += actuator.held_moment(acting, drive)
        return total

    def moment(self, u: np.ndarray, force: np.ndarray) -> np.ndarray:
        """Moment (3,) [N·m] about the origin of forces (size, 3) on the bodies' rows: points take it at
        their places, directors as they turn."""
        total = np.zeros(3)
        for body, place in self._bodies:
            rest = body.rest
            total += np.cross(rest + u[place][: len(rest)], force[place][: len(rest)]).sum(axis=0)
        return total

    def wrenches(self, u: np.ndarray, exerted: np.ndarray) -> dict[str, np.ndarray]:
        """Force and moment of each segment on the sheet, (segments, 6) [N, N·m] by actuator, from what holds
        masses and rows, (size, 3) [N]."""
        found: dict[str, np.ndarray] = {}
        for actuator, acting in self._acting(u, exerted):
            found.update(zip(actuator.names, actuator.wrenches(acting), strict=True))
        return found

    def _acting(
        self, u: np.ndarray, exerted: np.ndarray
    ) -> Iterator[tuple[BoundChain | RigidMotion, Acting]]:
        for actuator, place in self._all:
            masses = actuator.masses
            positions = self._positions[masses] + u[masses]
            yield actuator, Acting(positions, exerted[masses], exerted[place], u[place])


def _motions(scene: Scene, lattice: Lattice) -> tuple[RigidMotion, ...]:
    motions = scene.motions()
    movers = np.zeros(lattice.mass_count)  # motions that a mass follows
    for motion in motions.values():
        movers[lattice.edge_columns(motion.edge)] += 1.0
    return tuple(
        RigidMotion(
            motion, name, scene.sheet, lattice, 1.0 / movers[lattice.edge_columns(motion.edge).ravel()]
        )
        for name, motion in motions.items()
    )


def _chains(scene: Scene, lattice: Lattice, moved: np.ndarray) -> tuple[list[BoundChain], list[SharedCorner]]:
    taken = moved.copy()
    for support in scene.supports:
        taken[held_columns(lattice, support, reached_parts(scene))] = True
    shared = shared_corners(scene, lattice, taken)
    brought = shared_ends(scene, shared)
    found: list[BoundChain] = []
    for edge, here in scene.chains().items():
        columns = lattice.edge_columns(edge)
        others = taken.copy()
        for end in held_ends(scene, edge):
            others[columns[-end]] = True
        masses = columns.ravel()
        masses = masses[~others[masses]]
        taken[masses] = True
        scale = scene.material.young * scene.sheet.thickness
        held = held_ends(scene, edge)
        chain = BoundChain(
            list(here.values()), tuple(here), scene.sheet, lattice, masses, scale, held, brought[edge]
        )
        found.append(chain)
    return found, shared


def _tie(corner: SharedCorner, first: tuple[BoundChain, int], second: tuple[BoundChain, int]) -> Tie:
    """Point and director of the second chain from those of the first; axes may lie at different heights."""
    rows = [
        begin + np.array([chain.frames.end_point(end), chain.frames.corner_row[end]])
        for (chain, begin), end in zip((first, second), corner.ends, strict=True)
    ]
    (one, _), (other, _) = first, second
    above = (other.offset - one.offset) / one.frames.length
    weights = np.array([[1.0, above], [0.0, other.frames.length / one.frames.length]])
    return Tie(rows[1], rows[0], weights)
