"""All actuators of a scene, bound to a lattice; their rows of the displacement come after the masses' rows.

A mass of an edge moved rigidly follows the motion, whatever else acts on it: scenes with supports that
contradict the motion are refused; two motions that share a corner share its force. Any other mass that a
support holds, in whichever component, stays with its support; a corner at which a chain has its base belongs
to the chain. Two chains on neighbouring edges have the corner in common (`lumped.actuators.corners`). A chain
that ends at a corner whose director a support or another chain's base holds is held there too, unless the
support moves over time: with an end that moves so the integrators do not keep the balance of energy. There,
and beside an edge moved rigidly, the sheet alone holds it. Chains on one edge are one actuator model.
"""

from collections.abc import Iterator

import numpy as np

from lumped.actuators.actuator import Drive, InterfaceForces, RigidMotion
from lumped.actuators.chain import BoundChain
from lumped.actuators.corners import (
    SharedCorner,
    Tie,
    adjacent_base,
    held_ends,
    redundant_constraints,
    shared_corners,
)
from lumped.coverage import held_columns, reached_parts
from lumped.lattice import Lattice
from sheetbench.scenes import EDGES, Scene

NO_ROWS = np.empty((0, 3))


class Coupling:
    """The actuators of a scene on a lattice. Arrays have `size` rows, first the masses', then each
    actuator's.

    bodies: actuators that have rows, in the order of the rows; moved: (masses,) bool, masses of edges moved
    rigidly; algebraic: (size, 3) bool, components that are multipliers; free: (rows, 3) bool, components of
    the bodies' rows that can move.
    """

    def __init__(self, scene: Scene, lattice: Lattice):
        self.masses = lattice.mass_count
        self._positions, self._layers = lattice.positions, {e: lattice.edge_columns(e) for e in EDGES}
        self._motions = _motions(scene, lattice)
        self.moved = np.zeros(lattice.mass_count, dtype=bool)
        for motion in self._motions:
            self.moved[motion.masses] = True
        self.bodies, shared = _chains(scene, lattice, self.moved)
        by_edge: dict[str, BoundChain | RigidMotion] = {motion.edge: motion for motion in self._motions}
        chains = {body.edge: body for body in self.bodies}
        self.ties = [_tie(corner, *(chains[edge] for edge in corner.edges)) for corner in shared]
        bases = {edge: next(iter(on_edge.values())).held_as for edge, on_edge in scene.chains().items()}
        self._held_by = [  # a chain, the end of it that another chain's base holds, and the base
            (chain, end, bases[neighbour])
            for chain in self.bodies
            for end in chain.corners
            if (neighbour := adjacent_base(scene, chain.edge, end))
        ]
        by_edge |= chains
        self._all = [by_edge[edge] for edge in dict.fromkeys(str(a.edge) for a in scene.actuators)]
        self.size = lattice.mass_count + sum(chain.rows for chain in self.bodies)
        none = np.zeros((self.masses, 3), dtype=bool)
        free = np.concatenate([none, *(chain.free for chain in self.bodies)])
        self.algebraic = np.concatenate([none, *(chain.multipliers for chain in self.bodies)])
        self.free = free[self.masses :]
        if self.ties:
            rank = np.concatenate([chain.frames.rank for chain in self.bodies])
            left_out = tuple(
                np.argwhere(self.algebraic)[redundant_constraints(self._free_gradient(), rank)].T
            )
            self.algebraic[left_out] = free[left_out] = False
        self.multipliers = int(self.algebraic.sum())

    def _free_gradient(self) -> np.ndarray:
        """Return the constraints' gradient at rest by the free rows, with tied rows eliminated."""
        gradient = self.constraint_gradient(np.zeros((self.size, 3))) * self.free
        for tie in self.ties:
            rows, others = tie.rows - self.masses, tie.others - self.masses
            gradient[:, others] += np.einsum("crq,rs->csq", gradient[:, rows], tie.weights)
            gradient[:, rows] = 0.0
        return gradient.reshape(len(gradient), -1)

    def pairs(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the ordered pairs of actuators' rows that are coupled, by row numbers."""
        by_body = [np.argwhere(body.pairs) + body.place.start for body in self.bodies]
        rows, columns = np.concatenate([np.empty((0, 2), int), *by_body]).T
        return rows, columns

    def carried(self) -> np.ndarray:
        """Return the magnitudes (size,) [N] of the forces in each row's sum, whose rounding limits the
        residual."""
        return np.concatenate([np.zeros(self.masses), *(np.full(a.rows, a.carried) for a in self.bodies)])

    def weight(self, acceleration: np.ndarray) -> np.ndarray:
        """Return the dead forces (rows, 3) [N] of a uniform acceleration on the actuators' rows."""
        return np.concatenate([np.empty((0, 3)), *(a.weight(acceleration) for a in self.bodies)])

    def axes(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Return, for every edge with chains, the rows (p,) of the segments' end points and their positions
        at rest (p, 3) [m]; several chains on an edge have the mean of their axes."""
        return {body.edge: (body.place.start + np.arange(len(body.axis)), body.axis) for body in self.bodies}

    def corners(self) -> list[tuple[BoundChain, int, np.ndarray]]:
        """Return the ends of bodies held at corners: body, end (0 or 1), the corner's masses (layers,)."""
        ends = [(body, end) for body in self.bodies for end in body.corners]
        return [(body, end, self._layers[body.edge][-end]) for body, end in ends]

    def apply_held_corners(self, u: np.ndarray) -> None:
        """Set chains' ends, and the masses bound to them, in a displacement u (size, 3) [m] to match the
        masses of held corners."""
        for chain, end, column in self.corners():
            u[chain.place] += chain.place_corner(end, self._positions[column, 2], u[column])
            u[chain.masses] = chain.binding @ u[chain.place]

    def prescribed_displacement(self, drive: Drive) -> np.ndarray:
        """Return the prescribed displacement (size, 3) [m] of the masses of moved edges."""
        u = np.zeros((self.size, 3))
        for motion in self._motions:
            u[motion.masses] = motion.prescribed_displacement(drive)
        return u

    def prescribed_velocity(self, time: float) -> np.ndarray:
        """Return the prescribed velocity (size, 3) [m/s] of the masses of moved edges, from a time [s] on."""
        velocity = np.zeros((self.size, 3))
        for motion in self._motions:
            velocity[motion.masses] = motion.velocity(time)
        return velocity

    def add_force(self, u: np.ndarray, drive: Drive, force: np.ndarray) -> float:
        """Add the actuators' internal force to `force` (size, 3) [N]; return their energy [J]."""
        energy = 0.0
        for body in self.bodies:
            stored, gradient = body.force(u[body.place], drive)
            energy += stored
            force[body.place] += gradient
        return energy

    def add_average_force(self, start: np.ndarray, end: np.ndarray, drive: Drive, force: np.ndarray) -> None:
        """Add the energy-conserving average of the internal force between two displacements."""
        for body in self.bodies:
            force[body.place] += body.average_force(start[body.place], end[body.place], drive)

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
        for body in self.bodies:
            dense = scale * body.tangent(u[body.place], drive)
            if damping and body.damped:
                dense += damping * body.damping_tangent(u[body.place])
            rows, columns = np.nonzero(body.pairs)
            parts.append(dense[rows, :, columns, :])
        np.add.at(blocks, slots, np.concatenate(parts))

    def constraint_gradient(self, u: np.ndarray) -> np.ndarray:
        """Return derivatives (multipliers, rows, 3) of all constraints by the rows after the masses: the
        multipliers' rows of the tangent."""
        of_multipliers = [np.empty((0, self.size - self.masses, 3))]
        for body in self.bodies:
            rows = body.tangent(u[body.place], Drive())[self.algebraic[body.place]]
            whole = np.zeros((len(rows), self.size - self.masses, 3))
            whole[:, body.place.start - self.masses : body.place.stop - self.masses] = rows
            of_multipliers.append(whole)
        return np.concatenate(of_multipliers)

    def mass_blocks(self) -> np.ndarray:
        """Return the mass of every pair of `pairs` [kg]."""
        return np.concatenate([np.empty(0), *(a.mass[a.pairs] for a in self.bodies)])

    def command_work(self, u: np.ndarray, drive: Drive, later: Drive) -> float:
        """Return the work [J] of the commands going from one drive to the next at displacement u."""
        return sum(b.force(u[b.place], later)[0] - b.force(u[b.place], drive)[0] for b in self.bodies)

    def add_damping_force(self, u: np.ndarray, v: np.ndarray, force: np.ndarray) -> float:
        """Add the damping force to `force` (size, 3) [N]; return the power taken [W]."""
        power = 0.0
        for body in self.bodies:
            taken, resisting = body.damping_force(u[body.place], v[body.place])
            power += taken
            force[body.place] += resisting
        return power

    def reactions(self, exerted: np.ndarray) -> dict[str, np.ndarray]:
        """Return the force (3,) [N] of every prescribed motion and held base, by its name among a solution's
        reactions; exerted: (size, 3) [N] that holds masses and rows."""
        forces: dict[str, np.ndarray] = {}
        for actuator, interface in self._interfaces(np.zeros_like(exerted), exerted):
            forces |= actuator.reactions(interface)
        for body, end, base in self._held_by:
            forces[base] = forces[base] + body.corner_force(end, self.on_rows(body, exerted))
        return forces

    def on_rows(self, body: BoundChain, exerted: np.ndarray) -> np.ndarray:
        """Return the force (rows, 3) [N] that holds a body's rows and the masses bound to them."""
        return exerted[body.place] + body.binding.T @ exerted[body.masses]

    def held_moment(self, u: np.ndarray, exerted: np.ndarray, drive: Drive) -> np.ndarray:
        """Return the moment (3,) [N·m] about the origin of the forces that hold the actuators, corners of
        chains included; exerted: (size, 3) [N] that holds masses and rows."""
        moments = (body.held_moment(interface, drive) for body, interface in self._interfaces(u, exerted))
        return sum(moments, np.zeros(3))

    def moment(self, u: np.ndarray, force: np.ndarray) -> np.ndarray:
        """Return the moment (3,) [N·m] about the origin of forces (size, 3) [N] on the bodies' points and
        directors, whose current vectors are the arms."""
        total = np.zeros(3)
        for body in self.bodies:
            rows = slice(body.place.start, body.place.start + len(body.rest))
            total += np.cross(body.rest + u[rows], force[rows]).sum(axis=0)
        return total

    def wrenches(self, u: np.ndarray, exerted: np.ndarray) -> dict[str, np.ndarray]:
        """Return force and moment of each segment on the sheet, (segments, 6) [N, N·m] by actuator; exerted:
        (size, 3) [N] that holds masses and rows."""
        wrenches: dict[str, np.ndarray] = {}
        for actuator, interface in self._interfaces(u, exerted):
            wrenches.update(zip(actuator.names, actuator.wrenches(interface), strict=True))
        return wrenches

    def _interfaces(
        self, u: np.ndarray, exerted: np.ndarray
    ) -> Iterator[tuple[BoundChain | RigidMotion, InterfaceForces]]:
        for actuator in self._all:
            masses, rows = actuator.masses, (NO_ROWS, NO_ROWS)
            if isinstance(actuator, BoundChain):
                rows = self.on_rows(actuator, exerted), u[actuator.place]
            yield actuator, InterfaceForces(self._positions[masses] + u[masses], exerted[masses], *rows)


def _motions(scene: Scene, lattice: Lattice) -> tuple[RigidMotion, ...]:
    motions = scene.motions()
    movers = np.zeros(lattice.mass_count)  # motions that a mass follows
    for motion in motions.values():
        movers[lattice.edge_columns(motion.edge)] += 1.0
    return tuple(RigidMotion(motion, name, scene.sheet, lattice, movers) for name, motion in motions.items())


def _chains(scene: Scene, lattice: Lattice, moved: np.ndarray) -> tuple[list[BoundChain], list[SharedCorner]]:
    taken = moved.copy()
    for support in scene.supports:
        taken[held_columns(lattice, support, reached_parts(scene))] = True
    shared = shared_corners(scene, lattice, taken)
    bodies: list[BoundChain] = []
    start = lattice.mass_count
    for edge, chains in scene.chains().items():
        columns, held = lattice.edge_columns(edge), held_ends(scene, edge)
        excluded = taken.copy()
        excluded[columns[[-end for end in held]]] = True
        masses = columns.ravel()
        masses = masses[~excluded[masses]]
        taken[masses] = True
        scale = scene.material.young * scene.sheet.thickness
        ends = [(one.edges.index(edge), one.ends) for one in shared if edge in one.edges]
        has_director = {both[number]: number == 0 for number, both in ends}
        names, data = tuple(chains), list(chains.values())
        body = BoundChain(data, names, scene.sheet, lattice, masses, scale, held, has_director, start)
        bodies.append(body)
        start += body.rows
    return bodies, shared


def _tie(corner: SharedCorner, one: BoundChain, other: BoundChain) -> Tie:
    """Return the tie of the second chain's point and director to the first's; axes may differ in height."""
    ends = ((c.place.start, c.frames, end) for c, end in zip((one, other), corner.ends, strict=True))
    others, rows = (first + np.array([on.end_point(end), on.corner_row[end]]) for first, on, end in ends)
    above = (other.offset - one.offset) / one.frames.length
    weights = np.array([[1.0, above], [0.0, other.frames.length / one.frames.length]])
    return Tie(rows, others, weights)
