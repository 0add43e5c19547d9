"""A lattice as a differentiable function of numbers of its scene."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from lumped.calibration import Calibration, default
from lumped.cell_fields import FIELD
from lumped.gradient import FORCES, Base, Equilibrium, Gradient
from lumped.mid_surface import MidSurface
from lumped.parameter_sides import of_changed
from lumped.statics.problem import LatticePath
from lumped.statics.solver import solve_path
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.numerics.continuation.stability import require_stable
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import AnyScene, require_static, scene_of


class Differentiable:
    """Displacement of a scene's masses as a differentiable function of values by name.

    Parameters
    ----------
    scene : Scene, str or Path
        Scene with a static answer, the name of one in the catalogue, or the path of its file.
    calibration : Calibration, optional
        Springs; by default the scene's, or consistent ones on nine masses along the shorter side.

    Notes
    -----
    The values are parameters of the scene, fields over its cells, and forces on the masses in addition to the
    scene's own, with the names of `lumped.gradient`.

    Examples
    --------
    >>> import lumped, numpy as np
    >>> sheet = lumped.Differentiable("one-edge-clamped")
    >>> young = np.full(sheet.base["cells.young"].shape, 5e7)
    >>> u = sheet.solve({"cells.young": young})
    >>> sheet.pullback(np.ones_like(u))["cells.young"].shape
    (8, 8)
    """

    def __init__(self, scene: AnyScene, calibration: Calibration | None = None):
        self.scene = scene_of(scene)
        require_static(self.scene)
        self._base = base = Base.of(self.scene, calibration or default(self.scene))
        self.calibration, self.cells, self.problem = base.calibration, base.cells, base.problem
        self._last: Equilibrium | None = None
        self._values = dict[str, np.ndarray]()

    @property
    def base(self) -> dict[str, np.ndarray]:
        """Fields of the unchanged scene over the cells, and zero forces."""
        return {**self.cells.base, FORCES: np.zeros_like(self.problem.loads.dead)}

    def at(self, points: np.ndarray) -> Any:
        """Return the sparse map (3 p, 3 n), both flat, of displacements to values at plan points (p, 2).
        Raises BadInput beside obstacles whose surface of contact is curved, and not linear in u."""
        if any(one.bent for one in self.problem.contacts):
            raise BadInput("at: the surface beside an obstacle is curved: take surface(points)")
        surface = MidSurface(self.problem.assembly.lattice, np.asarray(points, dtype=float))
        return surface.matrix(len(self.problem.loads.dead))

    def surface(self, points: np.ndarray) -> tuple[np.ndarray, MidSurface]:
        """Return the last solve's displacement (p, 3) [m] at plan points (p, 2), and the map of its
        changes."""
        return self._solved.surface(points)

    def solve(self, values: Mapping[str, Any]) -> np.ndarray:
        """Return the displacement (n, 3) [m] of the stable equilibrium with the given values; the search
        starts from the last solution. Raises NoEquilibrium where there is none, BadInput for other names."""
        return self._reached(values).u

    def _reached(self, values: Mapping[str, Any]) -> Equilibrium:
        at, path = self.path(values, None if self._last is None else self._last.u)
        require_stable("lumped", path.status, path.notes)
        self._last, self._values = at, {name: np.array(value, float) for name, value in values.items()}
        return at

    @property
    def _solved(self) -> Equilibrium:
        return self._last or self._reached({})

    def path(self, values: Mapping[str, Any], near: np.ndarray | None) -> tuple[Equilibrium, LatticePath]:
        """Return the equilibrium with the given values and the path to it, started from `near` (n, 3) if
        possible."""
        base, scene, springs, numbers = self._base, self.scene, self.calibration, self.checked(values)
        fields = {name: numbers.pop(name) for name in values if name.startswith(FIELD) or name == FORCES}
        for name, value in numbers.items():
            ((scene, springs),) = of_changed(scene, springs, [(name, value.item())])
        if scene is not self.scene:
            base = Base(scene, springs)
        problem = base.with_values(fields)
        near = None if problem.assembly.coupling is not None else near
        with one_blas_thread():
            path = solve_path(problem, near=near)
            if near is not None and path.status is not Status.CONVERGED:
                path = solve_path(problem)
        return Equilibrium(base, path.state.u, fields, problem), path

    def checked(self, values: Mapping[str, Any]) -> dict[str, np.ndarray]:
        """Return values as arrays. Raises BadInput for an unknown field, and for one of another shape."""
        arrays = {name: np.asarray(value, dtype=float) for name, value in values.items()}
        for name, array in arrays.items():
            shape = array.shape if array.size == 1 else ()
            if name.startswith(FIELD) or name == FORCES:
                shape = (self.problem.loads.dead if name == FORCES else self.cells.value(name, {})).shape
            if array.shape != shape:
                raise BadInput(f"{name}: shape {array.shape}; {shape} is needed")
        return arrays

    def at_points(self, points: np.ndarray, names: Iterable[str]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Return the scene's own displacement (p, 3) at plan points (p, 2), and its derivatives by name."""
        at = self._reached({})
        return at.surface(points)[0], {name: at.displacement_rate(points, name) for name in names}

    def pullback(self, by_displacement: np.ndarray) -> Gradient:
        """Return the derivatives of J by name at the last solve's values; by_displacement: ∂J/∂u (n, 3)."""
        return self._solved.pullback(by_displacement)

    def vjp(self, values: Mapping[str, Any], by_displacement: np.ndarray) -> dict[str, np.ndarray]:
        """Return the derivatives of J by every given value, in its shape; by_displacement: ∂J/∂u (n, 3).
        Values that are not the last solve's are solved first."""
        last = self._values
        same = self._last is not None and last.keys() == values.keys()
        if not (same and all(np.array_equal(value, last[name]) for name, value in values.items())):
            self.solve(values)
        found = self.pullback(by_displacement)
        return {name: np.reshape(found[name], np.shape(value)) for name, value in values.items()}

    def pushforward(self, changes: Mapping[str, Any]) -> np.ndarray:
        """Return the change (n, 3) [m] of u by changes of the last solve's values, to first order."""
        return self._solved.pushforward(changes)
