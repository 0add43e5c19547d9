"""Kinematics of edges that a support bends or tilts or an actuator moves, one for every model.

A point X of the edge goes to X + u and its director from e_z to R(θ) e_z, with a rotation vector θ; a point
at the height ζ on the director moves by u + ζ (R − I) e_z. At load factor λ

    curved   θ = λκs e × e_z,   u = (sin λκs/λκ − s) e + (1 − cos λκs)/λκ e_z,   s along e
    tilt     θ = λτ n × e_z,    u = 0,                                           n out of the sheet
    motion   θ = λϑ(t),         u = λd(t) + (R − I)(X − X_m),                    X_m the edge's middle
    support that moves  adds λd to u, in the components it holds, and turns nothing

with s measured from the rod's middle, and d and ϑ at a time t, in statics their last values. The director
changes to first order in λ by θ × e_z, and u is ½ λκs² e_z, 0 and λd + θ × (X − X_m). A motion's velocity is
ḋ + ω × R(X − X_m), with ω = (sin ϑ/ϑ + (1 − cos ϑ)/ϑ² [ϑ]× + (1 − sin ϑ/ϑ)/ϑ² ϑ ϑᵀ) ϑ̇.

Solvers share the kinematics, a part of the question, but no mechanics: the masses, nodes or columns of an
edge, their constraints and reactions are each solver's own.
"""

from typing import NamedTuple

import numpy as np

from sheetbench.scenes.objects.actuators import EdgeMotion
from sheetbench.scenes.objects.sheet import EDGES, Sheet
from sheetbench.scenes.objects.supports import AnySupport, Clamped, Curved, Symmetric, held_axes, named
from sheetbench.scenes.objects.tables import PiecewiseCurve

UP = np.array([0.0, 0.0, 1.0])
_CROSS = np.cross(np.eye(3)[:, None], np.eye(3)[None]).swapaxes(1, 2).reshape(3, 9)  # [e]× of the axes


class Displaced(NamedTuple):
    """Position of k points of an edge: displacement u (k, 3) [m], turn R − I (k, 3, 3), or one (3, 3)."""

    displacement: np.ndarray
    turn: np.ndarray

    @property
    def director(self) -> np.ndarray:
        """Return the director's change, (k, 3) or (3,)."""
        return self.turn[..., 2]

    def lifted(self, height: np.ndarray) -> np.ndarray:
        """Return the displacement (k, 3) [m] of points at heights (k,) [m] on the directors."""
        return np.asarray(self.displacement + height[:, None] * self.director)


class TurnedEdge:
    """An edge on a bent rod or in a tilted clamp."""

    def __init__(self, support: Curved | Clamped, supports: tuple[AnySupport, ...], sheet: Sheet):
        self.edge: str = support.edge
        edge = EDGES[support.edge]
        self._axis, self._along, self._normal = edge.along_axis, np.eye(3)[edge.along_axis], edge.outward
        self._middle = _middle(support, supports, sheet)
        self._curvature, self._tilt = getattr(support, "curvature", 0.0), getattr(support, "tilt", 0.0)

    def displaced(self, points: np.ndarray, load_factor: float = 1.0, time: float | None = None) -> Displaced:
        """Return the position of plan points (k, 2) [m], which does not depend on the time."""
        s = points[:, self._axis] - self._middle
        half = 0.5 * load_factor * self._curvature * s
        # sin κs/κ − s and (1 − cos κs)/κ by sinc, which has no trouble at κ = 0
        across, rise = s * (np.sinc(2.0 * half / np.pi) - 1.0), s * np.sin(half) * np.sinc(half / np.pi)
        turn = _turn(load_factor * self._rotation(s))
        return Displaced(np.outer(across, self._along) + np.outer(rise, UP), turn)

    def linear(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return displacement [m] and change of director, (k, 3), to first order, at load factor 1."""
        s = points[:, self._axis] - self._middle
        return np.outer(0.5 * self._curvature * s**2, UP), np.cross(self._rotation(s), UP)

    def _rotation(self, s: np.ndarray) -> np.ndarray:
        bent, tilted = np.cross(self._along, UP), np.cross(self._normal, UP)
        return np.outer(self._curvature * s, bent) + self._tilt * tilted


class MovedEdge:
    """An edge moved rigidly."""

    def __init__(self, motion: EdgeMotion, sheet: Sheet):
        self.edge: str = motion.edge
        self._middle = np.mean(sheet.edge_ends(motion.edge), axis=0)
        still = ((0.0, 0.0, 0.0),) * len(motion.time)
        self._displacement = PiecewiseCurve(motion.time, motion.displacement or still)
        self._rotation = PiecewiseCurve(motion.time, motion.rotation or still)

    def displaced(self, points: np.ndarray, load_factor: float = 1.0, time: float | None = None) -> Displaced:
        """Return the position of plan points (k, 2) [m] at a time [s], the last without one."""
        turn = _turn(load_factor * self._rotation.at(time))
        turned = (points - self._middle) @ turn[:, :2].T
        return Displaced(load_factor * self._displacement.at(time) + turned, turn)

    def linear(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return displacement (k, 3) [m] and change of director (3,), to first order, at load factor 1."""
        cross = cross_matrix(self._rotation.at())
        return self._displacement.at() + (points - self._middle) @ cross[:, :2].T, cross[:, 2]

    def velocity(self, points: np.ndarray, height: np.ndarray, time: float) -> np.ndarray:
        """Return the velocity (k, 3) [m/s], just after a time [s], of points at heights (k,) [m]."""
        rotation, rate = self._rotation.at(time), self._rotation.slope(time)
        arms = np.column_stack([points - self._middle, height])
        turning = cross_matrix(_angular_velocity(rotation, rate)) @ (np.eye(3) + _turn(rotation))
        return np.asarray(self._displacement.slope(time) + arms @ turning.T)


DrivenEdge = TurnedEdge | MovedEdge


def bent_or_tilted(supports: tuple[AnySupport, ...], sheet: Sheet) -> list[TurnedEdge]:
    """Return the edges that supports bend or tilt."""
    turning = (s for s in supports if isinstance(s, Curved | Clamped))
    turning = (s for s in turning if getattr(s, "curvature", 0.0) or getattr(s, "tilt", 0.0))
    return [TurnedEdge(support, supports, sheet) for support in turning]


class Shift(NamedTuple):
    """Last displacement of a moving support, by its name in answers, along the axes that it holds [m]."""

    support: str
    axes: tuple[int, ...]
    displacement: np.ndarray


def shifts(supports: tuple[AnySupport, ...]) -> list[Shift]:
    """Return the supports' displacements at the last sample of their motions, which statics take."""
    moving = [(name, s, s.motion) for name, s in named(supports).items() if s.motion is not None]
    ends = [(name, held_axes(s), np.array(motion.displacement[-1])) for name, s, motion in moving]
    return [Shift(name, axes, last[list(axes)]) for name, axes, last in ends]


def _middle(rod: Curved | Clamped, supports: tuple[AnySupport, ...], sheet: Sheet) -> float:
    """Return the middle of a bent rod along its edge [m]: on the plane of symmetry that it meets, if any."""
    along = EDGES[rod.edge].along_axis
    for support in supports:
        if isinstance(support, Symmetric) and EDGES[support.edge].normal_axis == along:
            return sheet.edge_at(support.edge)
    return sheet.lengths[along] / 2.0


def cross_matrix(rotation: np.ndarray) -> np.ndarray:
    """Return [θ]× (…, 3, 3) of vectors (…, 3)."""
    return (rotation @ _CROSS).reshape(*rotation.shape, 3)


def _turn(rotation: np.ndarray) -> np.ndarray:
    """Return R(θ) − I = sin θ/θ [θ]× + (1 − cos θ)/θ² [θ]×², (…, 3, 3), of rotation vectors (…, 3)."""
    cross = cross_matrix(rotation)
    sine, versine = (c[..., None, None] for c in _coefficients(rotation))
    return np.asarray(sine * cross + versine * (cross @ cross))


def _angular_velocity(rotation: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """Return ω (3,) [rad/s] of a rotation vector (3,) and its rate."""
    sine, versine = _coefficients(rotation)
    along = (1.0 - sine) / max(rotation @ rotation, np.finfo(float).tiny) * (rotation @ rate)
    return np.asarray(sine * rate + versine * (cross_matrix(rotation) @ rate) + along * rotation)


def _coefficients(rotation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return sin θ/θ and (1 − cos θ)/θ²."""
    angle = np.linalg.norm(rotation, axis=-1)
    return np.sinc(angle / np.pi), 0.5 * np.sinc(0.5 * angle / np.pi) ** 2
