"""A lattice as a differentiable function of numbers of its scene."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from lumped.calibration import Calibration, default
from lumped.gradient import FIELD, FORCES, Equilibrium, Gradient
from lumped.mid_surface import MidSurface
from lumped.parameter_sides import Calibrate, of_changed
from lumped.statics.problem import LatticePath, Problem
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
    calibrate : callable, optional
        Function that calibrates a changed scene; by default the calibration's method without options.

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

    def __init__(
        self, scene: AnyScene, calibration: Calibration | None = None, calibrate: Calibrate | None = None
    ):
        self.scene = scene_of(scene)
        require_static(self.scene)
        self.calibration, self._calibrate = calibration or default(self.scene), calibrate
        self._unsolved = Equilibrium.of(self.scene, self.calibration, None, calibrate)
        self.cells = self._unsolved.cells
        self._last, self._values = self._unsolved, dict[str, np.ndarray]()

    @property
    def base(self) -> dict[str, np.ndarray]:
        """The scene's own fields over the cells, and zero forces."""
        fields = {FIELD + name: field for name, field in self.cells.base.items()}
        return {**fields, FORCES: np.zeros_like(self._unsolved.u)}

    @property
    def problem(self) -> Problem:
        """The scene's lattice under its supports and loads, with its own values."""
        return self._unsolved.problem

    def at(self, points: np.ndarray) -> Any:
        """Return the sparse map (3 p, 3 n), both flat, of displacements to values at plan points (p, 2).
        Raises BadInput beside obstacles whose surface of contact is curved, and not linear in u."""
        if any(one.bent for one in self.problem.contacts):
            raise BadInput("at: the surface beside an obstacle is curved: take surface(points)")
        return self._unsolved.surface(points)[1].matrix(len(self._unsolved.u))

    def surface(self, points: np.ndarray) -> tuple[np.ndarray, MidSurface]:
        """Return the last solve's displacement (p, 3) [m] at plan points (p, 2), and the map of its
        changes."""
        return self._solved().surface(points)

    def solve(self, values: Mapping[str, Any]) -> np.ndarray:
        """Return the displacement (n, 3) [m] of the stable equilibrium with the given values, sought from the
        last solution first. Raises NoEquilibrium where there is none, BadInput for other names."""
        at, path = self.path(values, None if self._last is self._unsolved else self._last.u)
        require_stable("lumped", path.status, path.notes)
        at.u, self._last = path.state.u, at
        self._values = {name: np.array(value, float) for name, value in values.items()}
        return path.state.u

    def path(self, values: Mapping[str, Any], near: np.ndarray | None) -> tuple[Equilibrium, LatticePath]:
        """Return an `Equilibrium` with the given values, its u not yet set, and the path to u, sought first
        from `near` (n, 3)."""
        scene, calibration, of_cells = self.scene, self.calibration, (FIELD, FORCES)
        fields = {name: np.asarray(v, float) for name, v in values.items() if name.startswith(of_cells)}
        for name in values.keys() - fields.keys():
            change = [(name, float(values[name]))]
            ((scene, calibration),) = of_changed(scene, calibration, change, self._calibrate)
        changed = scene is not self.scene
        base = Equilibrium(scene, calibration, self._calibrate) if changed else self._unsolved
        at = base.at(base.u, fields)
        near = None if at.problem.assembly.coupling is not None else near
        with one_blas_thread():
            path = solve_path(at.problem, near=near)
            if near is not None and path.status is not Status.CONVERGED:
                path = solve_path(at.problem)
        return at, path

    def at_points(self, points: np.ndarray, names: Iterable[str]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Return the scene's own displacement (p, 3) at plan points (p, 2), and its derivatives by name."""
        self.solve({})
        return self.surface(points)[0], {name: self._last.moved_at(points, name) for name in names}

    def pullback(self, by_displacement: np.ndarray) -> Gradient:
        """Return the derivatives of J by name at the last solve's values; by_displacement: ∂J/∂u (n, 3)."""
        return self._solved().pullback(by_displacement)

    def vjp(self, values: Mapping[str, Any], by_displacement: np.ndarray) -> dict[str, np.ndarray]:
        """Return the derivatives of J by every given value, in its shape; by_displacement: ∂J/∂u (n, 3).
        Values that are not the last solve's are solved first."""
        last = self._values
        same = last.keys() == values.keys() and self._last is not self._unsolved
        if not (same and all(np.array_equal(value, last[name]) for name, value in values.items())):
            self.solve(values)
        found = self.pullback(by_displacement)
        return {name: np.reshape(found[name], np.shape(value)) for name, value in values.items()}

    def pushforward(self, changes: Mapping[str, Any]) -> np.ndarray:
        """Return the change (n, 3) [m] of u by changes of the last solve's values, to first order."""
        return self._solved().pushforward(changes)

    def _solved(self) -> Equilibrium:
        if self._last is self._unsolved:
            self.solve({})
        return self._last
