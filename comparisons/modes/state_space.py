"""A scene's lattice, linear about its equilibrium: matrices, state space of the lowest modes or of the most
important states, their files: the answer of `sheetbench modes --state-space`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.models.context import context
from comparisons.models.resolve import resolve
from comparisons.models.sizes import require_states
from comparisons.models.spec import Lattice
from comparisons.pictures.array_files import write_mat, write_npz
from comparisons.pictures.work import Work
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Write
from sheetbench.answers.solution import About
from sheetbench.answers.table import HERTZ, MILLIMETRES, PERCENT, Table, TableUnit
from sheetbench.errors import BadInput
from sheetbench.scenes import AnyScene, Scene, scene_of

if TYPE_CHECKING:
    from lumped import Balanced, Linear, StateSpace

MODES = 20
BALANCED = "balanced"
UNITS = {"fx": "N", "fy": "N", "fz": "N", "curvature": "1/m", "x": "m", "y": "m", "z": "m"}
UNITS |= dict.fromkeys(("kxx", "kyy", "kxy"), "1/m")
EXPLANATION = (
    "static: steady displacement for an input of one unit; factor: 1 is the load or the gravity as the scene "
    "has it",
    "--out DIR writes M, C, K, F, F_rate, G, H and ss_A to ss_D to linear.npz and linear.mat",
)


MATRICES = {
    **{"M": "mass", "C": "damping", "K": "stiffness", "F": "force", "F_rate": "force_rate"},
    **{"G": "output", "H": "direct", "jacobian": "jacobian"},
}
POLES = (
    *(HERTZ(".5g", "frequency"), PERCENT("z.3g", "damping ratio"), TableUnit("1/s", "1/s")("z.5g", "real")),
    TableUnit("rad/s", "rad/s")(".5g", "imaginary"),
)
LOOSE, TIGHT = 0.1, 0.05  # bounds of a reduced model: complained of above, and advised instead


@dataclass(frozen=True, eq=False, repr=False)
class Linearisation(Answer):
    """matrices: of all unknowns; modal: state space of the modes requested; balanced: what it was reduced to,
    if it was; label: of the lattice."""

    file_name = "linear"
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
        return np.asarray(poles[poles.imag >= 0.0])

    def document(self) -> dict[str, Any]:
        """Return poles, inputs, outputs and static gains, and what a reduction promises."""
        poles, matrices = self.space.poles, self.matrices
        form = {
            "label": self.label,
            "unknowns": matrices.mass.shape[0],
            "poles": np.column_stack([poles.real, poles.imag]),
            "frequencies_hz": self.space.frequencies,
            "inputs": list(matrices.inputs),
            "outputs": list(matrices.outputs),
            "jacobian": matrices.jacobian,
            **self._reduction,
        }
        lattice = {"model": "lumped", "label": self.label, "frequencies_hz": self.modal.frequencies}
        about = {"scene": self.scene.document(), "about": self.about}
        return {**about, "solutions": [lattice], "state_space": form}

    @property
    def _reduction(self) -> dict[str, Any]:
        """Describe the balanced truncation, where there is one."""
        if self.balanced is None:
            return {}
        return {"hankel": self.balanced.hankel, "bound": self.balanced.bound, "scale": self.balanced.scale}

    def arrays(self) -> dict[str, Any]:
        """Return what `linear.mat` and `linear.npz` hold; matrices of all unknowns are sparse."""
        full = {name: getattr(self.matrices, of) for name, of in MATRICES.items()}
        modal = {f"ss_{name.upper()}": getattr(self.space, name) for name in "abcd"}
        names = {name: np.array(getattr(self.matrices, name)) for name in ("inputs", "outputs")}
        return {**full, **modal, "frequencies_hz": self.space.frequencies, **names, **self._reduction}

    def heading(self) -> tuple[str, str, str]:
        about = "flat sheet" if self.about == "flat" else "equilibrium"
        inputs, outputs = len(self.matrices.inputs), len(self.matrices.outputs)
        lead = (
            f"{self.label}, about the {about}: {self.matrices.mass.shape[0]} unknowns, a state space of "
            f"{len(self.space.a)} states, {inputs} inputs, {outputs} outputs"
        )
        return self.scene.name, self.scene.title, lead

    def tables(self) -> tuple[Table, ...]:
        """Return the poles, and what inputs do at rest: on terminals along z alone."""
        of = self.matrices
        moved = (MILLIMETRES("z.4g", name, detail=not name.endswith(" uz")) for name in of.outputs)
        inputs = zip(of.inputs, of.jacobian.T, strict=True)
        rows = ((name, unit_of(name), *column) for name, column in inputs)
        caption = "Static displacement per unit of input"
        return self._poles(), Table.listed(caption, ("input", "unit", *moved), rows, "jacobian")

    def _poles(self) -> Table:
        """Return a row per pair of poles: the slowest first."""
        pairs = zip(self.upper, self.damping_ratios, strict=True)
        rows = [(abs(p) / (2.0 * np.pi), ratio, p.real, p.imag) for p, ratio in pairs]
        undamped = not any(self.damping_ratios)
        columns = [replace(one, detail=undamped and one.name in ("damping ratio", "real")) for one in POLES]
        return Table.listed("Poles (undamped)" if undamped else "Poles", columns, rows, "poles")

    def files(self) -> dict[str, Write]:
        """Return the matrices; in MATLAB and Octave ss(ss_A, ss_B, ss_C, ss_D)."""
        values = self.arrays()
        return {
            "linear.npz": partial(write_npz, values=values),
            "linear.mat": partial(write_mat, values=values),
        }

    def choices(self) -> dict[str, Any]:
        return {"label": self.label, "about": self.about, "states": len(self.space.a)}

    def result(self) -> str:
        lowest = int(np.argmin(np.abs(self.upper)))
        frequency, ratio = abs(self.upper[lowest]) / (2.0 * np.pi), 100.0 * self.damping_ratios[lowest]
        return f"lowest of {len(self.space.a)} states: {frequency:.4g} Hz, damping ratio {ratio:.3g} %"

    def notes(self) -> tuple[str, ...]:
        if self.balanced is None:
            return EXPLANATION
        return (
            f"balanced: {self.balanced.order} of {len(self.modal.a)} states; the error of every "
            f"response is below {100.0 * self.balanced.bound:.3g} % of its static value at all frequencies, "
            "and 0 at frequency 0",
            *EXPLANATION,
        )

    def complaints(self) -> list[str]:
        if self.balanced is None or self.balanced.bound <= LOOSE:
            return []
        off, enough = f"{100.0 * self.balanced.bound:.3g} %", self.balanced.order_within(TIGHT)
        return [
            f"balanced: {self.balanced.order} states may be off by {off} of the static response; {enough} "
            f"keep the error below {100.0 * TIGHT:g} % (--reduce balanced:{TIGHT:g})"
        ]


def unit_of(name: str) -> str:
    """Return the unit of an input by the last word of its name; of a load and gravity "factor", of what the
    scene has."""
    return UNITS.get(name.replace(".", " ").split()[-1], "factor")


def linearise(
    scene: AnyScene,
    lattice: Lattice = Lattice(),  # noqa: B008  # frozen
    *,
    modes: int | None = MODES,
    reduce: str | None = None,
    about: About = "deformed",
) -> Linearisation:
    """Return the lattice of a scene about its equilibrium under its loads, or about the flat sheet.

    modes: of the state space, all for None; those that there are where they are fewer. reduce: them further,
    "balanced:8" to that many states, "balanced:0.01" to as few as keep the bound on the error within that
    share of what an input does at rest. Raises BadInput for choices that do not exist, for what has no linear
    form (`lumped.linearise`) and what cannot be balanced (`lumped.StateSpace`).
    """
    import lumped

    scene = scene_of(scene)
    if modes is not None and modes < 1:
        raise BadInput(f"modes = {modes}: at least 1")
    order, tolerance = _balance(reduce)
    model = resolve(scene, lattice, "motion")
    springs = model.springs
    context().progress(Work("linearising the lattice", model.size))
    found = lumped.linearise(scene, springs, about)
    most = found.mass.shape[0]
    require_states(2 * min(modes or most, most))
    space = found.state_space(None if modes is None else min(modes, most))
    balanced = None if reduce is None else space.balanced(order, tolerance)
    return Linearisation(scene, f"lumped {springs.title}", about, found, space, balanced)


def _balance(reduce: str | None) -> tuple[int | None, float | None]:
    """Return the order or the tolerance that "balanced:8" or "balanced:0.01" asks for."""
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
