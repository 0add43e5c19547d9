"""A scene's lattice, linear about its equilibrium: matrices, state space of the lowest modes or of the most
important states, their files."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.linearisation import tables
from comparisons.models.grading import Grading
from comparisons.models.grids import GridLike
from comparisons.models.registry import check
from comparisons.models.sizes import size
from comparisons.models.springs import LatticeSpec
from comparisons.report.work import Progress, Work, silent
from sheetbench.answers.report import Report
from sheetbench.errors import BadInput, require_choice
from sheetbench.files import whole
from sheetbench.scenes import AnyScene, Scene, scene_of

if TYPE_CHECKING:
    from lumped import Balanced, Linear, StateSpace

MODES = 20
BALANCED = "balanced"
ABOUT = ("deformed", "flat")


@dataclass(frozen=True, eq=False)
class Linearisation:
    """matrices: of all unknowns; modal: state space of the modes asked for; balanced: what it was reduced to,
    if it was; label: of the lattice."""

    scene: Scene
    label: str
    about: str
    matrices: Linear
    modal: StateSpace
    balanced: Balanced | None = None

    @property
    def space(self) -> StateSpace:
        """The state space that is shown and written."""
        return self.modal if self.balanced is None else self.balanced.space

    @cached_property
    def damping_ratios(self) -> np.ndarray:
        """−Re s/|s| of the poles above the real axis, or on it."""
        upper = self.upper
        return -upper.real / np.abs(upper)

    @property
    def upper(self) -> np.ndarray:
        """The poles of each pair above the real axis, and those on it [rad/s]."""
        poles = self.space.poles
        found: np.ndarray = poles[poles.imag >= 0.0]
        return found

    def as_dict(self) -> dict[str, Any]:
        """The JSON document of `sheetbench linearise`: SI units."""
        poles, matrices = self.space.poles, self.matrices
        return {
            "scene": self.scene.document(),
            "label": self.label,
            "about": self.about,
            "unknowns": matrices.mass.shape[0],
            "poles": np.column_stack([poles.real, poles.imag]),
            "frequencies_hz": self.space.frequencies,
            "inputs": list(matrices.inputs),
            "outputs": list(matrices.outputs),
            "jacobian": matrices.jacobian,
            **self._reduction,
        }

    @property
    def _reduction(self) -> dict[str, Any]:
        """Of the balanced truncation, where there is one."""
        if self.balanced is None:
            return {}
        return {"hankel": self.balanced.hankel, "bound": self.balanced.bound, "scale": self.balanced.scale}

    def arrays(self) -> dict[str, Any]:
        """What `linear.mat` and `linear.npz` hold; matrices of all unknowns are sparse."""
        matrices, space = self.matrices, self.space
        return {
            "M": matrices.mass,
            "C": matrices.damping,
            "K": matrices.stiffness,
            "F": matrices.force,
            "F_rate": matrices.force_rate,
            "G": matrices.output,
            "H": matrices.direct,
            "jacobian": matrices.jacobian,
            "ss_A": space.a,
            "ss_B": space.b,
            "ss_C": space.c,
            "ss_D": space.d,
            "frequencies_hz": space.frequencies,
            "inputs": np.array(matrices.inputs),
            "outputs": np.array(matrices.outputs),
            **self._reduction,
        }

    def write_npz(self, path: Path) -> None:
        """Write the arrays for NumPy, a sparse matrix M as M_data, M_indices, M_indptr of its columns."""
        parts: dict[str, Any] = {}
        for name, value in self.arrays().items():
            if hasattr(value, "indptr"):
                parts |= {f"{name}_{part}": getattr(value, part) for part in ("data", "indices", "indptr")}
            else:
                parts[name] = value
        with whole(path) as partial:
            np.savez(partial, **parts)

    def write_mat(self, path: Path) -> None:
        """Write the arrays for MATLAB and Octave: there ss(ss_A, ss_B, ss_C, ss_D)."""
        from scipy.io import savemat

        texts = {name: np.array(list(self.arrays()[name]), dtype=object) for name in ("inputs", "outputs")}
        with whole(path) as partial:
            savemat(partial, {**self.arrays(), **texts}, oned_as="column")

    def report(self) -> Report:
        """What is shown of it."""
        return tables.report(self)


def linearise(
    scene: AnyScene,
    *,
    grid: GridLike = None,
    calibration: str | None = None,
    k: float | None = None,
    layer_distance: float | None = None,
    grading: Grading = None,
    modes: int | None = MODES,
    reduce: str | None = None,
    about: str = "deformed",
    large: bool = False,
    progress: Progress = silent,
) -> Linearisation:
    """The lattice of a scene about its equilibrium under its loads, or about the flat sheet.

    modes: of the state space, all for None; those that there are where they are fewer. reduce: them further,
    "balanced:8" to that many states, "balanced:0.01" to as few as keep the bound on the error within that
    share of what an input does at rest. Raises BadInput for choices that do not exist, for what has no linear
    form (`lumped.linearise`) and what cannot be balanced (`lumped.StateSpace`).
    """
    import lumped

    asked = scene_of(scene)
    require_choice("about", about, ABOUT)
    if modes is not None and modes < 1:
        raise BadInput(f"modes = {modes}: at least 1")
    order, tolerance = _balance(reduce)
    lattice = LatticeSpec(grid, calibration, k, layer_distance, grading)
    check(asked, lattice.candidate, large)
    springs, _ = lattice.springs(asked)
    progress(Work("linearising the lattice", size(asked, lattice.candidate)))
    found = lumped.linearise(asked, springs, "flat" if about == "flat" else "deformed")
    most = found.mass.shape[0]
    space = found.state_space(None if modes is None else min(modes, most))
    balanced = None if reduce is None else space.balanced(order, tolerance)
    return Linearisation(asked, f"lumped {springs.title}", about, found, space, balanced)


def _balance(reduce: str | None) -> tuple[int | None, float | None]:
    """The order or the tolerance that "balanced:8" or "balanced:0.01" asks for."""
    if reduce is None:
        return None, None
    name, _, number = reduce.partition(":")
    if name == BALANCED and number.isdecimal() and len(number) < 10:
        return int(number), None
    try:
        tolerance = float(number) if name == BALANCED else np.nan
    except ValueError:
        tolerance = np.nan
    if not 0.0 < tolerance < np.inf:
        raise BadInput(f"--reduce = '{reduce}': {BALANCED}:8 for states, {BALANCED}:0.01 for a bound")
    return None, tolerance
