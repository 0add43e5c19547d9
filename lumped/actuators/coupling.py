"""All actuators of a scene, bound to a lattice: their rows follow those of the masses in the displacement.

A mass of an edge moved rigidly follows the motion, whatever else acts on it: scenes refuse what the motion
would contradict; where two motions share a corner they share its force. Any other mass that a support holds,
in whichever component, stays with its support; one that two chains on neighbouring edges could bind stays
with the first. A chain that ends at a corner whose director a support holds is held there too, unless the
support moves over time: with an end that moves so the integrators do not keep the balance of energy. There,
and beside an edge moved rigidly, the sheet alone holds it. Chains on one edge are one
actuator model.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from lumped.actuators.actuator import Actuator, Drive
from lumped.actuators.chain import Chain
from lumped.actuators.edge_motion import RigidMotion
from lumped.lattice import Lattice
from sheetbench.scenes import EDGES, EdgeMotion, Scene, holds_director


class Coupling:
    """The actuators with the place of each one's rows; all arrays over masses and rows together."""

    def __init__(self, scene: Scene, lattice: Lattice):
        self.masses = lattice.mass_count
        self._positions = lattice.positions
        self.actuators: tuple[Actuator, ...] = _actuators(scene, lattice)
        ends = np.cumsum([lattice.mass_count, *(a.rows for a in self.actuators)])
        self._layers = {edge: lattice.edge_columns(edge) for edge in EDGES}
        self._places = [slice(int(a), int(b)) for a, b in pairwise(ends)]
        self.size = int(ends[-1])
        self.multipliers = sum(a.multipliers for a in self.actuators)
        self.algebraic = np.zeros((self.size, 3), dtype=bool)  # components that are multipliers
        for actuator, place in self._each():
            first = actuator.rows - -(-actuator.multipliers // 3)
            self.algebraic[place][first:] = actuator.free[first:]

    def __len__(self) -> int:
        return len(self.actuators)

    def _each(self) -> list[tuple[Actuator, slice]]:
        return list(zip(self.actuators, self._places, strict=True))

    @property
    def moved(self) -> np.ndarray:
        """Masses of edges moved rigidly, (masses,) bool."""
        moved = np.zeros(self.masses, dtype=bool)
        for actuator in self.actuators:
            if isinstance(actuator, RigidMotion):
                moved[actuator.masses] = True
        return moved

    @property
    def free(self) -> np.ndarray:
        """Components of the actuators' rows that can move, (rows, 3) bool."""
        return np.concatenate([np.empty((0, 3), bool), *(a.free for a in self.actuators)])

    def pairs(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows that act on each other, as ordered pairs of numbers after the masses."""
        found = [np.argwhere(a.pairs) + place.start for a, place in self._each()]
        rows, columns = np.concatenate([np.empty((0, 2), int), *found]).T
        return rows, columns

    def bindings(self) -> list[tuple[np.ndarray, np.ndarray, int]]:
        """For every actuator: bound masses (m,), binding (m, rows), number of its first row."""
        return [(a.masses, a.binding, place.start) for a, place in self._each()]

    def carried(self) -> np.ndarray:
        """Forces (size,) [N] on the actuators' rows whose rounding the residual cannot fall below."""
        forces = np.zeros(self.size)
        for actuator, place in self._each():
            forces[place] = actuator.carried
        return forces

    def weight(self, acceleration: np.ndarray) -> np.ndarray:
        """Dead forces (rows, 3) [N] of a uniform acceleration on the actuators' rows."""
        return np.concatenate([np.empty((0, 3)), *(a.weight(acceleration) for a in self.actuators)])

    def axes(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Of every edge with chains: the rows of the points where their segments end, (p,), and the points'
        rest places (p, 3) [m]; of several chains on an edge the mean of their axes."""
        return {
            actuator.edge: (place.start + np.arange(len(points)), points)
            for actuator, place in self._each()
            if len(points := actuator.axis)
        }

    def corners(self) -> list[tuple[Chain, slice, int, np.ndarray]]:
        """Ends of chains held at corners: chain, its place, end (0 or 1), the corner's masses (layers,)."""
        return [
            (actuator, place, end, self._layers[actuator.edge][-end])
            for actuator, place in self._each()
            if isinstance(actuator, Chain)
            for end in actuator.frames.corners
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
        """Prescribed displacement (size, 3) [m] of the bound masses."""
        moved = np.zeros((self.size, 3))
        for actuator, _ in self._each():
            moved[actuator.masses] = actuator.driven(drive)
        return moved

    def driven_velocity(self, time: float) -> np.ndarray:
        """The velocity (size, 3) [m/s] of what is prescribed, from a time [s] on."""
        velocity = np.zeros((self.size, 3))
        for actuator in self.actuators:
            if isinstance(actuator, RigidMotion):
                velocity[actuator.masses] = actuator.velocity(time)
        return velocity

    def add_force(self, u: np.ndarray, drive: Drive, force: np.ndarray) -> float:
        """Add the actuators' internal force to `force` (size, 3) [N]; their energy [J]."""
        energy = 0.0
        for actuator, place in self._each():
            stored, gradient = actuator.force(u[place], drive)
            energy += stored
            force[place] += gradient
        return energy

    def add_average_force(self, start: np.ndarray, end: np.ndarray, drive: Drive, force: np.ndarray) -> None:
        """Add the energy-conserving average of the internal force between two displacements."""
        for actuator, place in self._each():
            force[place] += actuator.average_force(start[place], end[place], drive)

    def add_tangent(self, u: np.ndarray, drive: Drive, slots: np.ndarray, blocks: np.ndarray) -> None:
        """Add the tangent to the 3×3 blocks at `slots`, one for every pair of `pairs`."""
        parts = [_at_pairs(a, a.tangent(u[place], drive)) for a, place in self._each()]
        if parts:
            np.add.at(blocks, slots, np.concatenate(parts))

    def add_damping_tangent(self, u: np.ndarray, scale: float, slots: np.ndarray, blocks: np.ndarray) -> None:
        """Add scale × the derivative of the damping force by the velocity."""
        parts = [_at_pairs(a, scale * a.damping_tangent(u[place])) for a, place in self._each()]
        if parts:
            np.add.at(blocks, slots, np.concatenate(parts))

    def constraint_gradient(self, u: np.ndarray) -> np.ndarray:
        """Derivatives (multipliers, rows, 3) of all constraints by the rows after the masses."""
        out = np.zeros((self.multipliers, self.size - self.masses, 3))
        first = 0
        for actuator, place in self._each():
            rows = slice(place.start - self.masses, place.stop - self.masses)
            out[first : first + actuator.multipliers, rows] = actuator.constraint_gradient(u[place])
            first += actuator.multipliers
        return out

    def mass_blocks(self) -> np.ndarray:
        """Mass of every pair of `pairs` [kg]."""
        return np.concatenate([np.empty(0), *(a.mass[a.pairs] for a in self.actuators)])

    def command_force(self, u: np.ndarray, drive: Drive) -> np.ndarray:
        """Derivative (size, 3) [N] of the internal force by the load factor."""
        force = np.zeros((self.size, 3))
        for actuator, place in self._each():
            force[place] = actuator.command_force(u[place], drive)
        return force

    def command_work(self, u: np.ndarray, drive: Drive, later: Drive) -> float:
        """Work [J] of the commands going from one drive to the next at displacement u."""
        return sum(actuator.command_power(u[place], drive, later) for actuator, place in self._each())

    def add_damping_force(self, u: np.ndarray, v: np.ndarray, force: np.ndarray) -> float:
        """Add the damping force to `force` (size, 3) [N]; the power taken [W]."""
        power = 0.0
        for actuator, place in self._each():
            taken, resisting = actuator.damping_force(u[place], v[place])
            power += taken
            force[place] += resisting
        return power

    def reactions(self, exerted: np.ndarray) -> dict[str, np.ndarray]:
        """Force (3,) [N] of every prescribed motion and held base, by its name among a solution's reactions,
        from what holds masses and rows, (size, 3) [N]."""
        found: dict[str, np.ndarray] = {}
        for actuator, place in self._each():
            found |= actuator.reactions(exerted[actuator.masses], exerted[place])
        return found

    def held_moment(self, u: np.ndarray, exerted: np.ndarray, drive: Drive) -> np.ndarray:
        """Moment (3,) [N·m] about the origin of what holds the actuators, corners of chains among it, from
        what holds masses and rows, (size, 3) [N]."""
        total = np.zeros(3)
        for actuator, place in self._each():
            positions = self._positions[actuator.masses] + u[actuator.masses]
            on = exerted[actuator.masses], exerted[place]
            total += actuator.held_moment(positions, *on, u[place], drive)
        return total

    def moment(self, u: np.ndarray, force: np.ndarray) -> np.ndarray:
        """Moment (3,) [N·m] about the origin of forces (size, 3) on the actuators' rows: points take it at
        their places, directors as they turn."""
        total = np.zeros(3)
        for actuator, place in self._each():
            rest = actuator.rest
            total += np.cross(rest + u[place][: len(rest)], force[place][: len(rest)]).sum(axis=0)
        return total

    def wrenches(self, u: np.ndarray, on_masses: np.ndarray) -> dict[str, np.ndarray]:
        """Force and moment of each segment on the sheet, (segments, 6) [N, N·m] by actuator, from the forces
        that the actuators exert on the masses, (size, 3) [N]."""
        found: dict[str, np.ndarray] = {}
        for actuator, place in self._each():
            positions = self._positions[actuator.masses] + u[actuator.masses]
            wrenches = actuator.wrenches(positions, on_masses[actuator.masses], u[place])
            if isinstance(actuator, Chain) and actuator.frames.corners:
                exerted = on_masses[place] + actuator.binding.T @ on_masses[actuator.masses]
                wrenches = wrenches + actuator.corner_wrenches(exerted, u[place])
            found.update(zip(actuator.names, wrenches, strict=True))
        return found


def _at_pairs(actuator: Actuator, dense: np.ndarray) -> np.ndarray:
    rows, columns = np.nonzero(actuator.pairs)
    return dense[rows, :, columns, :]


def _actuators(scene: Scene, lattice: Lattice) -> tuple[Actuator, ...]:
    motions = [a.edge for a in scene.actuators if isinstance(a, EdgeMotion)]
    movers = np.zeros(lattice.mass_count, dtype=int)  # motions that a mass follows
    for edge in motions:
        movers[lattice.edge_columns(edge)] += 1
    taken = movers > 0
    for support in scene.supports:
        taken[lattice.edge_columns(support.edge)] = True
    found: list[Actuator] = []
    for edge in dict.fromkeys(a.edge for a in scene.actuators):
        here = [(name, a) for name, a in scene.named_actuators().items() if a.edge == edge]
        masses = lattice.edge_columns(edge).ravel()
        name, only = here[0]
        if isinstance(only, EdgeMotion):
            found.append(RigidMotion(only, name, scene.sheet, lattice, masses, 1.0 / movers[masses]))
            continue
        masses = masses[~taken[masses]]
        taken[masses] = True
        chains = [a for _, a in here if not isinstance(a, EdgeMotion)]
        scale = scene.material.young * scene.sheet.thickness
        corners = tuple(end for end in (0, 1) if _corner_is_held(scene, edge, end))
        labels = tuple(n for n, _ in here)
        found.append(Chain(chains, labels, scene.sheet, lattice, masses, scale, corners))
    return tuple(found)


def _corner_is_held(scene: Scene, edge: str, end: int) -> bool:
    """Whether a support on the neighbouring edge at an end of this one holds position and director there."""
    beside = f"{'xy'[EDGES[edge].along_axis]}{end}"
    moved = any(isinstance(actuator, EdgeMotion) and actuator.edge == beside for actuator in scene.actuators)
    here = [support for support in scene.supports if support.edge == beside and support.motion is None]
    return not moved and any(holds_director(support) for support in here)
