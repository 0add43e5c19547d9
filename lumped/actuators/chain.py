"""Habibi et al.'s actuator: a chain of rigid segments with mass and rotary inertia, torsional springs and
dampers.

Lagrangian of the rows y (see `lumped.actuators.frames`), with multipliers λ [m] and the scale σ [N/m]:

    L = ½ ẏ·M ẏ − Σ_joints ½ k |φ(y) − κ ds|² + g·M y − σ ds Σ λ Φ(y),     k = EI/ds  (2 EI/ds at a held base)

Joints are damped with damping_time × k.

The segments of this module are the equal parts into which `lumped.actuators.division` divides the scene's
segments; forces are given for the scene's segments. Chains of a pair are one kinematic chain on the mean of
their axes, each with its own joints, mass and offset. `lumped.actuators.binding` binds masses of the edge to
them.

A corner whose position and director another edge holds also holds the chain's end point and, by a joint of
half length, the bending and the twist of its end segment, which may turn about the director. The joint has
the curvature of the next joint. Two chains that share a corner have its point and director in common.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lumped.actuators import joints
from lumped.actuators.actuator import Drive, InterfaceForces
from lumped.actuators.binding import bind, mass_matrix
from lumped.actuators.division import mean_curvatures, parts_of_a_segment
from lumped.actuators.frames import Frames
from lumped.lattice import Lattice
from sheetbench.scenes import EDGES, Sheet
from sheetbench.scenes import Chain as ChainData

UP = np.array([0.0, 0.0, 1.0])


class BoundChain:
    """One or several chains on one edge. place: slice of its rows among all rows of the lattice; scale: σ
    [N/m], like the sheet's E h; held: its ends (0 the start, 1 the end) where another edge holds position and
    director; shared: ends whose corner another chain shares, with a flag for ends where the director's row is
    this chain's.

    rows: number of its rows; free: (rows, 3) bool, components that can move; multipliers: (rows, 3) bool,
    components that are multipliers; pairs: (rows, rows) bool, rows that appear together in tangent, damping
    or mass; masses: (m,) bound by binding (m, rows); mass: (rows, rows) [kg], for each of the three axes;
    carried: force [N] whose rounding the residual cannot fall below; rest: (k, 3) [m] points, then directors,
    at rest, which the first k rows displace; axis: the points (p, 3) among them, where its segments end;
    corners: its ends (0, 1) at which a corner of the sheet holds it.
    """

    def __init__(
        self,
        chains: Sequence[ChainData],
        names: tuple[str, ...],
        sheet: Sheet,
        lattice: Lattice,
        masses: np.ndarray,
        scale: float,
        held: tuple[int, ...] = (),
        shared: Mapping[int, bool] | None = None,
        start: int = 0,
    ):
        first = chains[0]
        self.edge: str = first.edge
        self.names, self._chains = names, tuple(chains)
        edge = EDGES[first.edge]
        along = np.eye(3)[edge.along_axis]
        offsets = np.array([chain.axis_height(sheet.thickness) for chain in chains])
        self.offset = float(offsets.mean())
        origin = np.append(np.array(sheet.edge_ends(first.edge)[0]), self.offset)
        axes = np.array([along, UP, edge.outward])
        self._parts = parts_of_a_segment(first, len(lattice.edge_columns(first.edge)) - 1)
        divided = first.replace(segments=self._parts * first.segments, curvature=0.0)
        self.frames = frames = Frames(divided, origin, sheet.lengths[edge.along_axis], axes, held, shared)
        self._scale = scale * frames.length  # σ ds
        self._commands = [(mean_curvatures(chain, frames), chain.curvatures()) for chain in chains]
        self.rest, self.axis, self.corners = frames.rest, frames.rest[: frames.points], frames.held
        multiplier_rows = -(-frames.constraints // 3)
        self.rows = frames.coordinates + multiplier_rows
        self.place = slice(start, start + self.rows)
        multipliers = np.arange(3 * multiplier_rows).reshape(-1, 3) < frames.constraints
        self.free = np.concatenate([frames.free, multipliers])
        self.multipliers = np.concatenate([np.zeros_like(frames.free), multipliers])
        self.masses = masses
        rest = lattice.positions[masses]
        arc_length, height = (rest - origin) @ along, rest[:, 2] - self.offset
        self.binding, self.share, self._arms = bind(frames, self.rows, arc_length, height)
        self.mass = mass_matrix(frames, self.rows, chains, offsets - self.offset)
        self._stiffness = np.array([c.bending_stiffness / frames.length / frames.share for c in chains])
        self.carried = float(self._stiffness.sum(axis=0).max(initial=0.0) / frames.length)
        self._damping = np.array([c.damping_time for c in chains]) @ self._stiffness
        self.damped = bool(self._damping.any())
        sample = frames.length * np.random.default_rng(0).standard_normal((self.rows, 3))
        coupled = self.tangent(sample, Drive()).any(axis=(1, 3))
        self.pairs = coupled | (self.mass != 0.0) | np.eye(self.rows, dtype=bool)

    def weight(self, acceleration: np.ndarray) -> np.ndarray:
        """Return the weight (rows, 3) [N] of the segments: the mass matrix times an acceleration of the
        points, since directors do not move in a translation. Chains off the mean axis load the directors
        too."""
        return self.mass[:, : self.frames.points].sum(axis=1)[:, None] * acceleration

    def force(self, y: np.ndarray, drive: Drive) -> tuple[float, np.ndarray]:
        """Return the joints' energy [J] and the gradient of energy + σ ds λ·Φ, (rows, 3) [N]."""
        at, springs, offset = self.frames.at(y), *self._joint_springs(drive)
        stored, by_measure, _ = joints.derivatives(at.measures, *springs)
        return float(stored.sum()) + offset, self._gradient(y, at.slopes, at.residuals, by_measure)

    def average_force(self, start: np.ndarray, end: np.ndarray, drive: Drive) -> np.ndarray:
        """Return the discrete gradient (rows, 3) [N], with constraint gradients at the mean, where their
        differences are exact; multiplier rows hold the constraints at the end, with the end's multipliers."""
        before, middle, after = (self.frames.at(y) for y in (start, 0.5 * (start + end), end))
        springs, _ = self._joint_springs(drive)
        by_measure = joints.average_gradient(before.measures, after.measures, *springs)
        return self._gradient(end, middle.slopes, after.residuals, by_measure)

    def tangent(self, y: np.ndarray, drive: Drive) -> np.ndarray:
        """Return joint stiffness, constraint gradients and both curvatures, (rows, 3, rows, 3) [N/m]."""
        frames, count = self.frames, self.frames.coordinates
        at, (springs, _) = frames.at(y), self._joint_springs(drive)
        _, by_measure, hessian = joints.derivatives(at.measures, *springs)
        gradient = frames.gradient(at.slopes).reshape(len(at.slopes), -1)
        of_joints = gradient[frames.constraints :].reshape(-1, 3, 3 * count)
        bent = np.einsum("jak,jab,jbl->kl", of_joints, hessian, of_joints, optimize=True)
        out = np.zeros((self.rows, 3, self.rows, 3))
        out[:count, :, :count, :] = bent.reshape(count, 3, count, 3)
        geometric = frames.curvature_of(self._weights(y, by_measure))
        for axis in range(3):
            out[:count, axis, :count, axis] += geometric
        flat = out.reshape(3 * self.rows, 3 * self.rows)
        multipliers = 3 * count + np.arange(frames.constraints)
        flat[multipliers, : 3 * count] = self._scale * gradient[: frames.constraints]
        flat[: 3 * count, multipliers] = flat[multipliers, : 3 * count].T
        return out

    def damping_force(self, y: np.ndarray, v: np.ndarray) -> tuple[float, np.ndarray]:
        """Return the power taken [W] and the force (rows, 3) [N] of c φ̇ on every joint's angles."""
        force = np.zeros_like(y)
        if not self.damped:
            return 0.0, force
        by_row, count = self._angle_gradient(y), self.frames.coordinates
        rate = by_row @ v[:count].ravel()
        torque = self._damping[:, None] * rate
        force[:count] = np.tensordot(torque, by_row, 2).reshape(-1, 3)
        return float((torque * rate).sum()), force

    def damping_tangent(self, y: np.ndarray) -> np.ndarray:
        """Return Σ c ∇φ ∇φᵀ, (rows, 3, rows, 3) [N·s/m]."""
        by_row, count = self._angle_gradient(y), self.frames.coordinates
        out = np.zeros((self.rows, 3, self.rows, 3))
        damped = np.einsum("j,jik,jil->kl", self._damping, by_row, by_row, optimize=True)
        out[:count, :, :count, :] = damped.reshape(count, 3, count, 3)
        return out

    def reactions(self, interface: InterfaceForces) -> dict[str, np.ndarray]:
        """Return the force (3,) [N] on the point that the base holds, by its name among reactions."""
        at = self.frames.base_joint
        return {} if at is None else {self._chains[0].held_as: interface.on_rows[at]}

    def held_moment(self, interface: InterfaceForces, drive: Drive) -> np.ndarray:
        """Return the moment (3,) [N·m] about the origin on the held points and directors and on a base's
        frame."""
        at, count = self.frames.at(interface.y), self.frames.coordinates
        whole = np.where(self.free, 0.0, interface.on_rows)[:count]
        moment = np.cross(self.frames.rest + interface.y[:count], whole).sum(axis=0)
        on_base = np.cross(self._arms, interface.on_masses).sum(axis=0)
        _, by_measure, _ = joints.derivatives(at.measures, *self._joint_springs(drive)[0])
        return moment + on_base + self.frames.ground_couple(at, self._weights(interface.y, by_measure))

    def place_corner(self, end: int, layers: np.ndarray, displacement: np.ndarray) -> np.ndarray:
        """Return the chain's displacement (rows, 3) [m] at an end held by a corner whose layers, at heights
        (l,) [m], are displaced by (l, 3) [m]."""
        frames, spread = self.frames, layers - layers.mean()
        tilt = spread @ displacement / (spread @ spread)
        y = np.zeros((self.rows, 3))
        y[frames.corner_row[end]] = frames.length * tilt
        y[frames.end_point(end)] = displacement.mean(axis=0) + (self.offset - layers.mean()) * tilt
        y[: frames.coordinates][self.free[: frames.coordinates]] = 0.0
        return y

    def corner_force(self, end: int, on_rows: np.ndarray) -> np.ndarray:
        """Return the force (3,) [N] that holds the point at a corner, from the forces on the rows."""
        point = self.frames.end_point(end)
        return np.where(self.free[point], 0.0, on_rows[point])

    def wrenches(self, interface: InterfaceForces) -> np.ndarray:
        """Return force and moment (names, segments, 6) [N, N·m] on the sheet about the middle of each
        segment's axis; chains of a pair share them evenly."""
        frames, exerted = self.frames, interface.on_rows
        position = frames.rest + interface.y[: frames.coordinates]
        first = self._parts * np.arange(frames.segments // self._parts)
        middle = 0.5 * (position[first + self._parts // 2] + position[first + (self._parts + 1) // 2])
        arm = interface.positions[None, :, :] - middle[:, None, :]
        share = np.add.reduceat(self.share, first)
        force = share @ interface.on_masses
        moment = np.einsum("sm,smq->sq", share, np.cross(arm, interface.on_masses[None, :, :]))
        total = np.concatenate([force, moment], axis=1)
        for end in frames.corners:  # on a free row only another chain's part of the corner acts
            segment, row = end * (len(first) - 1), frames.corner_row[end]
            push = exerted[frames.end_point(end)] if end in frames.shared else self.corner_force(end, exerted)
            couple = np.cross(position[row], exerted[row])
            lever = position[frames.end_point(end)] - middle[segment]
            total[segment] -= np.concatenate([push, np.cross(lever, push) + couple])
        return np.tile(total / len(self.names), (len(self.names), 1, 1))

    def _joint_springs(self, drive: Drive) -> tuple[tuple[np.ndarray, np.ndarray], float]:
        """Return the stiffness (j,) [N·m/rad] and rest angles (j, 2) of the chain equivalent to all chains
        together, and the energy [J] stored because their rest angles differ."""
        frames, stiffness = self.frames, self._stiffness.sum(axis=0)
        curvature = np.array([pieces @ values.at(drive.time) for pieces, values in self._commands])
        natural = drive.load_factor * curvature[:, frames.command] * frames.length * frames.share
        rest = np.zeros((len(stiffness), 2))
        mean = (self._stiffness * natural).sum(axis=0) / stiffness
        rest[:, 1 if self._chains[0].plane == "inplane" else 0] = mean
        stored = 0.5 * float((self._stiffness * natural**2).sum() - (stiffness * mean**2).sum())
        return (stiffness, rest), stored

    def _weights(self, y: np.ndarray, by_measure: np.ndarray) -> np.ndarray:
        """Return the derivative of energy + σ ds λ·Φ by every constraint and measure."""
        multipliers = y[self.frames.coordinates :].ravel()[: self.frames.constraints]
        return np.concatenate([self._scale * multipliers, by_measure.ravel()])

    def _gradient(
        self, y: np.ndarray, slopes: np.ndarray, residuals: np.ndarray, by_measure: np.ndarray
    ) -> np.ndarray:
        out, count = np.zeros((self.rows, 3)), self.frames.coordinates
        out[:count] = np.tensordot(self._weights(y, by_measure), self.frames.gradient(slopes), axes=1)
        out[count:].ravel()[: len(residuals)] = self._scale * residuals
        return out

    def _angle_gradient(self, y: np.ndarray) -> np.ndarray:
        """Return the derivatives (j, 2, 3 coordinates) of the joints' angles by the rows."""
        at = self.frames.at(y)
        _, first, _ = joints.angles(at.measures)
        gradient = self.frames.gradient(at.slopes)[self.frames.constraints :]
        return np.matmul(first, gradient.reshape(len(first), 3, -1))
