"""Balance of a surface model: the total load, computed from the scene and the shape alone, and the reactions.

    force     dead loads  given by the scene (`dead_force`)
              pressure    ½ p ∮ φ × dφ
    moment    weight      ∫ ρ (φ + z d) dV × g        chain      ρ_l ∫ (φ + c d) dL × g
              payload     m φ(x) × g, or m ⟨φ⟩ × g
              point       φ(x) × F                    edge       ∫ φ dL × q + m ∫ (|d|² t̂ − (d · t̂) d) dL
              pressure    −½ p ∮ |φ|² dφ

about the origin of the flat sheet's frame, with the position φ, the director d and the unit tangent t̂ of the
edge on the deformed sheet; A and L are the flat sheet's, ∮ runs counter-clockwise around it: by Stokes'
theorem a pressure's force and moment depend on the rim alone. Only the sides of edges are taken from `loads`,
with whose nodal forces the model has been solved. All integrands but t̂ are of fifth degree at most and
integrated exactly; t̂ is taken at the points where `loads` applies the moment.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fem_reference.surface.actuator_forces import RodOnEdge
from fem_reference.surface.biquadratic import AT_GAUSS, THREE, THREE_WEIGHTS, areas, side_shape
from fem_reference.surface.loads import Line
from fem_reference.surface.location import interpolate
from fem_reference.surface.materials import constants_of
from fem_reference.surface.mesh import Plan, facets_on
from sheetbench.answers.balance import Balance, dead_force
from sheetbench.scenes import EdgeLoad, PointLoad, Pressure, Scene
from sheetbench.scenes.objects.loads import AreaLoad
from sheetbench.scenes.objects.masses import Mass
from sheetbench.scenes.objects.quantities import PlanPoint
from sheetbench.scenes.objects.shapes import Shape

_VALUE, _SLOPE = side_shape(THREE)  # (3 points, 3 nodes)


@dataclass(frozen=True)
class Surface:
    """Deformed sheet: its plan, φ [m] and d (n, 3) of the nodes. own_outline: whether the mesh has its
    outline in place of the scene's sheet."""

    plan: Plan
    position: np.ndarray
    director: np.ndarray
    own_outline: bool = False

    def at(self, point: PlanPoint) -> np.ndarray:
        """Return φ (3,) [m] at a plan point [m]."""
        plan = self.plan
        return interpolate(plan.mesh, plan.elements, self.position, np.array([point]))[0]

    def masses(self, scene: Scene) -> np.ndarray:
        """Return w |det J| ρh (m, 9) [kg] at the Gauss points of a scene's sheet."""
        return areas(self.plan.corners) * constants_of(scene, self.plan.corners).per_area

    def first_moment(self, scene: Scene) -> np.ndarray:
        """Return ∫ ρ (φ + z d) dV (3,) [kg m] of a scene's sheet."""
        of, weights = constants_of(scene, self.plan.corners), areas(self.plan.corners)
        masses = np.array([weights * per_area for per_area in (of.per_area, of.moment_per_area)])
        vectors = np.array([self.position, self.director])[:, self.plan.elements]
        return np.asarray(np.einsum("peg,pegc->c", masses, AT_GAUSS[0] @ vectors))

    def lengths(self, sides: np.ndarray) -> np.ndarray:
        """Return w |X,ξ| (k, 3) [m] at the points of sides (k, 3)."""
        return THREE_WEIGHTS * np.linalg.norm(_SLOPE @ self.plan.nodes[sides], axis=-1)


def applied(scene: Scene, surface: Surface, edges: Sequence[RodOnEdge]) -> tuple[np.ndarray, np.ndarray]:
    """Return the total force [N] and moment [N·m] (3,) of all loads and weights, including chains on
    edges."""
    force, moment = _dead_force(scene, surface), np.zeros(3)
    if scene.gravity is not None:
        parts = [surface.first_moment(scene)]
        parts += [_first_moment(payload, surface) for payload in scene.masses]
        parts += [_of_chains(edge, surface, scene.sheet.thickness) for edge in edges]
        moment = np.cross(np.sum(parts, axis=0), scene.gravity.last_acceleration)
    for load in scene.loads:
        factor = load.last_factor
        match load:
            case PointLoad():
                moment = moment + factor * np.cross(surface.at(load.at), load.force)
            case EdgeLoad():
                moment = moment + factor * _edge_moment(load, surface)
            case AreaLoad():
                weights, at = _area(load.where, surface)
                force = force + factor * weights.sum() * np.array(load.force_per_area)
                moment = moment + factor * np.cross(np.einsum("eg,egc->c", weights, at), load.force_per_area)
            case Pressure():
                pushed, turned = _pressure(surface, load.where)
                force, moment = force + factor * load.value * pushed, moment + factor * load.value * turned
    return force, moment


def load_balance(
    scene: Scene,
    surface: Surface,
    edges: Sequence[RodOnEdge],
    reactions: Mapping[str, np.ndarray],
    held: Sequence[tuple[np.ndarray, np.ndarray]],
    size: float,
    allowed: float,
    share: float,
) -> Balance:
    """Return the residual force and moment of a model under a share of the load. reactions: of its supports,
    by name; held: pairs of positions and holding forces (…, 3); size and allowed: fields of `Balance`."""
    force, moment = applied(scene, surface, edges)
    longest = float(np.ptp(surface.plan.nodes, axis=0).max())
    turning = [np.cross(places, forces).reshape(-1, 3).sum(axis=0) for places, forces in held]
    force = share * force + np.sum(list(reactions.values()), axis=0)
    moment, arm = share * moment + np.sum(turning, axis=0), float(np.linalg.norm(held[0][0], axis=-1).max())
    return Balance(force, moment, size, allowed, max(longest, arm))


def _dead_force(scene: Scene, surface: Surface) -> np.ndarray:
    """Return the total dead force; area loads are left out, as their area is the mesh's own."""
    others = tuple(load for load in scene.loads if not isinstance(load, AreaLoad))
    scene = scene.model_copy(update={"loads": others})
    if not surface.own_outline and scene.uniform and not scene.pierced:
        return dead_force(scene)
    mass = float(surface.masses(scene).sum())
    if not surface.own_outline:
        return dead_force(scene, mass)
    sides = {name: Line.along(surface.plan, on) for name, on in (surface.plan.mesh.boundaries or {}).items()}
    lengths = {name: float(surface.lengths(line.nodes).sum()) for name, line in sides.items()}
    return dead_force(scene, mass, lengths)


def _of_chains(edge: RodOnEdge, surface: Surface, thickness: float) -> np.ndarray:
    """Return ∫ ρ_l (φ + c d) dL [kg m], the first mass moment of a rod's chains, from its own positions and
    directors."""
    values = np.concatenate([edge.position, edge.director], axis=1)[edge.rod.places]
    line = np.einsum("kg,gi,kic->c", surface.lengths(edge.rod.nodes), _VALUE, values)
    chains = edge.rod.chains.values()
    return sum(c.line_density * (line[:3] + c.axis_height(thickness) * line[3:]) for c in chains)


def _edge_moment(load: EdgeLoad, surface: Surface) -> np.ndarray:
    sides = Line.along(surface.plan, facets_on(surface.plan.mesh, load)).nodes
    weights = surface.lengths(sides)
    position, director = (_VALUE @ values[sides] for values in (surface.position, surface.director))
    slope = _SLOPE @ surface.position[sides]
    tangent = slope / np.linalg.norm(slope, axis=-1, keepdims=True)
    square, along = ((director * other).sum(axis=-1, keepdims=True) for other in (director, tangent))
    couple = np.einsum("kg,kgc->c", weights, square * tangent - along * director)
    middle = np.einsum("kg,kgc->c", weights, position)
    return np.cross(middle, load.force_per_length) + load.moment_per_length * couple


def _first_moment(payload: Mass, surface: Surface) -> np.ndarray:
    """Return the first mass moment m φ [kg m] of a payload, with φ at its point or the mean φ of its part of
    the sheet."""
    if payload.at is not None:
        return payload.mass * surface.at(payload.at)
    weights, at = _area(payload.where, surface)
    return payload.mass * np.einsum("eg,egc->c", weights / weights.sum(), at)


def _area(where: Shape | None, surface: Surface) -> tuple[np.ndarray, np.ndarray]:
    """Return w |det J| (k, 9) [m²] and φ (k, 9, 3) [m] at the Gauss points of elements in a shape, or all."""
    plan = surface.plan
    on = plan.elements[plan.within(where)]
    return areas(plan.nodes[on]), AT_GAUSS[0] @ surface.position[on]


def _pressure(surface: Surface, where: Shape | None) -> tuple[np.ndarray, np.ndarray]:
    """Return force [m²] and moment [m³] of a unit pressure; its rim runs clockwise, the sheet to the
    right."""
    plan, mesh = surface.plan, surface.plan.mesh
    inside = np.isin(mesh.f2t, plan.within(where))
    facets = np.flatnonzero(inside.sum(axis=0) == 1)
    rim = surface.position[Line.along(plan, facets, np.where(inside[0], *mesh.f2t)[facets]).nodes]
    at, slope = _VALUE @ rim, _SLOPE @ rim
    square = (at * at).sum(axis=-1, keepdims=True)
    parts = np.cross(slope, at), square * slope
    force, moment = (np.einsum("g,kgc->c", THREE_WEIGHTS, part) for part in parts)
    return 0.5 * force, 0.5 * moment
