"""Loads on the masses: dead forces, follower pressure and follower edge moment, with their tangents.

gravity        mass × acceleration, tributary masses; inertial masses of a sheet without supports
point          shared bilinearly among the columns of its cell, equally among the layers
edge force     per undeformed length, by tributary lengths, equally among the layers
edge moment    per undeformed length: a couple F = ±M (t × D)/|D|² on the outer layers of each column, D the
               vector between them, t the current edge tangent (central difference of the neighbours' mean)
pressure       along the normal of every mid-surface cell, per current area (`lumped.pressure`)

A load's `history` multiplies it by its factor at a time; statics use the last factor. A factor on a dead load
makes its work depend on the path in time: only constant dead loads have a potential.

Follower loads have unsymmetric tangents, all but pressure on a sheet whose edges sweep no area
(`scenes.encloses_volume`), which has a potential; see e.g. Schweizerhof and Ramm (1984).
"""

from dataclasses import dataclass

import numpy as np

from lumped.assembly import Assembly
from lumped.coverage import areas_of_masses, cell_shares
from lumped.lattice import Lattice
from lumped.masses import masses
from lumped.mid_surface import MidSurface
from lumped.pressure import add_couples, add_forces, add_tangent
from sheetbench.numerics.cache import frozen
from sheetbench.scenes import (
    EDGES,
    AreaLoad,
    EdgeLoad,
    FactorTable,
    PiecewiseCurve,
    PointLoad,
    Pressure,
    Scene,
    encloses_volume,
)
from sheetbench.scenes.meaning.region import edge_parts


@dataclass
class LoadPart:
    """Loads that share a history, if they have one.

    dead: (n, 3) [N]; pressure: (cells,) [Pa] times the share of each present cell under it; columns, moments:
    of edges, (e, 3, p) and (e,) [N·m] (see `lumped.pressure.add_couples`).
    """

    history: PiecewiseCurve | None
    dead: np.ndarray
    pressure: np.ndarray
    columns: np.ndarray
    moments: np.ndarray

    def factor(self, time: float | None) -> float:
        """Return the history's factor at a time [s]; the last one without a time."""
        return 1.0 if self.history is None else float(self.history.at(time))


class Loads:
    """The external forces of a scene at load factor 1; every load scales with the load factor.

    dead: (n, 3) [N] dead loads without a history; last_dead, pressure: (n, 3) [N] and (cells,) [Pa] of all
    loads with their last factors; follow: whether some loads follow the sheet; turning: whether there are
    edge moments; conservative: whether all have a potential at a given time; potential: whether `dead` is the
    only load."""

    def __init__(self, scene: Scene, assembly: Assembly):
        self._assembly = assembly
        lattice = assembly.lattice
        self._parts: dict[FactorTable | None, LoadPart] = {}
        self.dead = self._part(None).dead
        if scene.gravity is not None:
            acceleration = np.array(scene.gravity.acceleration)
            dead = self._part(scene.gravity.history).dead
            held = scene.supports or any(getattr(a, "base", "held") != "free" for a in scene.actuators)
            weight = masses(scene, lattice, "tributary" if held else assembly.inertia, assembly.cells)
            dead[: lattice.mass_count] += weight[:, None] * acceleration
            if assembly.coupling is not None:
                dead[lattice.mass_count :] += assembly.coupling.weight(acceleration)
        for load in scene.loads:
            part = self._part(load.history)
            if isinstance(load, PointLoad):
                middle = MidSurface(lattice, np.array(load.at), order=1)
                part.dead += middle.shared(np.array([load.force]), len(part.dead))
            elif isinstance(load, EdgeLoad):
                edge = lattice.edge_columns(load.edge)
                length = _lengths(scene, lattice, load)
                edge, length = edge[length > 0.0], length[length > 0.0]
                force = length[:, None] * np.array(load.force_per_length) / lattice.grid[2]
                part.dead[edge] += force[:, None, :]
                if load.moment_per_length:
                    along = np.eye(3)[EDGES[load.edge].along_axis]
                    turn = np.cross(EDGES[load.edge].outward, [0.0, 0.0, 1.0]) @ along
                    at = np.arange(len(edge))
                    neighbours = edge[np.maximum(at - 1, 0)], edge[np.minimum(at + 1, len(edge) - 1)]
                    part.columns = np.append(part.columns, np.stack([edge, *neighbours], axis=1), axis=0)
                    part.moments = np.append(part.moments, turn * length * load.moment_per_length)
            elif isinstance(load, AreaLoad):
                area = areas_of_masses(scene, lattice, load.where)
                part.dead[: len(area)] += area[:, None] * np.array(load.force_per_area)
            elif isinstance(load, Pressure):
                part.pressure += load.value * cell_shares(scene, lattice, load.where)
        last = [(part.factor(None), part) for part in self._parts.values()]
        self.pressure = sum(factor * part.pressure for factor, part in last)
        with_history = [factor * part.dead for factor, part in last[1:]]
        self.last_dead = np.sum([self.dead, *with_history], axis=0) if with_history else self.dead
        self.turning = any(len(part.moments) for _, part in last)
        self.follow = self.turning or any(part.pressure.any() for _, part in last)
        enclosed = self.follow and encloses_volume(scene.supports) and not scene.shaped_by
        self.conservative = not self.turning and (enclosed or not self.follow)
        self.potential = not self.follow and len(last) == 1
        frozen(tuple(part.dead for part in self._parts.values()))

    @property
    def parts(self) -> tuple[LoadPart, ...]:
        """Loads by history, first the loads without one."""
        return tuple(self._parts.values())

    def _part(self, history: FactorTable | None) -> LoadPart:
        """Return the part with a history, created at its first use."""
        if history not in self._parts:
            course = None if history is None else PiecewiseCurve(history.time, history.factor)
            lattice = self._assembly.lattice
            dead, pressure = np.zeros((self._assembly.pattern.size, 3)), np.zeros(len(lattice.mid_cells))
            no_columns = np.empty((0, 3, lattice.grid[2]), dtype=int)
            self._parts[history] = LoadPart(course, dead, pressure, no_columns, np.empty(0))
        return self._parts[history]

    def at_time(self, time: float | None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return columns (e, 3, p) and moments (e,) [N·m] of edges, and pressure (cells,) [Pa], at a time."""
        scaled = [(part.factor(time), part) for part in self._parts.values()]
        columns = np.concatenate([part.columns for _, part in scaled])
        moments = np.concatenate([by * part.moments for by, part in scaled])
        return columns, moments, np.sum([by * part.pressure for by, part in scaled], axis=0)

    def force(self, u: np.ndarray, time: float | None = None) -> np.ndarray:
        """Return the external force (n, 3) [N] at a displacement u (n, 3) [m] and a time [s]; without a time
        (statics) with the last factor of every history. The array must not be written to."""
        force = self.dead_at(time)
        return force + self.followers(u, time) if self.follow else force

    def dead_at(self, time: float | None = None) -> np.ndarray:
        """Return the part (n, 3) [N] of the force that does not follow the sheet; not to be written to."""
        if time is None or self.potential:
            return self.last_dead
        return np.sum([part.factor(time) * part.dead for part in self._parts.values()], axis=0)

    def work(self, u: np.ndarray) -> float:
        """Return the work [J] of conservative loads from the flat sheet to u (n, 3) [m], Σ z F_z of a
        pressure."""
        pressure = self.followers(u)
        masses = self._assembly.lattice.mass_count
        heights = self._assembly.lattice.positions[:, 2] + u[:masses, 2]
        return float(np.sum((self.force(u) - pressure) * u) + heights @ pressure[:masses, 2])

    def followers(self, u: np.ndarray, time: float | None = None) -> np.ndarray:
        """Return the part (n, 3) [N] of the force that follows the sheet."""
        force = np.zeros_like(self.dead)
        if not self.follow:
            return force
        x = self._assembly.lattice.positions + u[: self._assembly.lattice.mass_count]
        columns, moments, pressure = self.at_time(time)
        if len(moments):
            add_couples(x, columns, moments, force)
        if pressure.any():
            add_forces(x, self._assembly.lattice.mid_cells, pressure, force)
        return force

    def add_tangent(
        self, u: np.ndarray, load_factor: float, blocks: np.ndarray, time: float | None = None
    ) -> None:
        """Subtract the derivative of load_factor × force from the tangent's blocks (b, 3, 3)."""
        if not self.follow:
            return
        x = self._assembly.lattice.positions + u[: self._assembly.lattice.mass_count]
        columns, moments, pressure = self.at_time(time)
        if len(moments):
            self._add_couple_tangent(x, columns, load_factor * moments, blocks)
        if pressure.any():
            cells = self._assembly.lattice.mid_cells
            slots = self._assembly.pattern.among(cells.reshape(len(cells), -1))
            add_tangent(x, cells, slots, -load_factor * pressure, blocks)

    def _add_couple_tangent(
        self, x: np.ndarray, columns: np.ndarray, moment: np.ndarray, blocks: np.ndarray
    ) -> None:
        before, after, top, bottom = columns[:, 1], columns[:, 2], columns[:, 0, -1], columns[:, 0, 0]
        chord, director = (x[after] - x[before]).mean(axis=1), x[top] - x[bottom]
        length, square = np.linalg.norm(chord, axis=1), (director**2).sum(axis=1)
        tangent, scale = chord / length[:, None], (moment / square)[:, None, None]
        couple = scale[:, 0] * np.cross(tangent, director)
        by_size = 2.0 * couple[:, :, None] * (director / square[:, None])[:, None, :]
        by_director = scale * _spin(tangent) - by_size
        projector = (np.eye(3) - tangent[:, :, None] * tangent[:, None, :]) / length[:, None, None]
        by_chord = -scale * _spin(director) @ projector / columns.shape[2]
        sources = np.column_stack([top, bottom, after, before])  # masses that the couple depends on
        layers = columns.shape[2]
        by = np.stack([by_director, -by_director, *layers * [by_chord], *layers * [-by_chord]], axis=1)
        for row, sign in ((top, -1.0), (bottom, 1.0)):
            np.add.at(blocks, self._assembly.pattern.slots(row[:, None], sources), sign * by)


def _lengths(scene: Scene, lattice: Lattice, load: EdgeLoad) -> np.ndarray:
    """Return the length of a load's edge that each of its masses represents, (m,) [m]."""
    lines = lattice.lines[EDGES[load.edge].along_axis]
    if not scene.pierced and load.where is None:
        return lines.tributary
    length = np.zeros(len(lines.at))
    for ends in edge_parts(scene, load.edge, load.where):
        start, stop = (np.clip(at, *ends) for at in (lines.at[:-1], lines.at[1:]))
        middle = (0.5 * (start + stop) - lines.at[:-1]) / lines.widths
        length[:-1] += (stop - start) * (1.0 - middle)
        length[1:] += (stop - start) * middle
    return length


def _spin(v: np.ndarray) -> np.ndarray:
    """Return [v]× of vectors (n, 3), (n, 3, 3)."""
    out = np.zeros((len(v), 3, 3))
    out[:, 0, 1], out[:, 0, 2] = -v[:, 2], v[:, 1]
    out[:, 1, 0], out[:, 1, 2] = v[:, 2], -v[:, 0]
    out[:, 2, 0], out[:, 2, 1] = -v[:, 1], v[:, 0]
    return out
