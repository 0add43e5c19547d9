"""A scene's lattice linearised about its equilibrium: matrices, a state space of the lowest modes or of the
most important states, and their files: the answer of `sheetbench modes --state-space`."""

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
    "static displacement: the steady displacement of a probe for a constant input of one unit; one unit of a "
    "factor is the scene's own load or gravity",
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
LOOSE, TIGHT = 0.1, 0.05  # error bounds of a reduced model: a complaint above LOOSE advises TIGHT


@dataclass(frozen=True, eq=False, repr=False)
class Linearisation(Answer):
    """A linearised lattice; matrices: of all unknowns; modal: state space of the requested modes; balanced:
    its balanced truncation, if requested; label: of the lattice."""

    file_name = "linear"
    scene: Scene
    label: str
    about: str
    matrices: Linear
    modal: StateSpace
    balanced: Balanced | None = None

    @property
    def space(self) -> StateSpace:
        """The state space for tables and files."""
        return self.modal if self.balanced is None else self.balanced.space

    @cached_property
    def damping_ratios(self) -> np.ndarray:
        """Damping ratios −Re s/|s| of the poles on or above the real axis."""
        upper = self.upper
        return -upper.real / np.abs(upper)

    @property
    def upper(self) -> np.ndarray:
        """The poles on or above the real axis [rad/s]."""
        poles = self.space.poles
        return np.asarray(poles[poles.imag >= 0.0])

    def document(self) -> dict[str, Any]:
        """Return poles, inputs, outputs, static gains, and the error bound of a reduction."""
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
        """The balanced truncation as JSON data, empty without one."""
        if self.balanced is None:
            return {}
        return {"hankel": self.balanced.hankel, "bound": self.balanced.bound, "scale": self.balanced.scale}

    def arrays(self) -> dict[str, Any]:
        """Return the arrays of `linear.mat` and `linear.npz`; matrices of all unknowns are sparse."""
        full = {name: getattr(self.matrices, attribute) for name, attribute in MATRICES.items()}
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
        """Return tables of the poles and of static displacements per input; a terminal shows z alone."""
        matrices = self.matrices
        outputs = (MILLIMETRES("z.4g", name, detail=not name.endswith(" uz")) for name in matrices.outputs)
        inputs = zip(matrices.inputs, matrices.jacobian.T, strict=True)
        rows = ((name, unit_of(name), *column) for name, column in inputs)
        caption = "Static displacement per unit of input"
        return self._poles(), Table.listed(caption, ("input", "unit", *outputs), rows, "jacobian")

    def _poles(self) -> Table:
        """Return a table with a row per pair of poles, the slowest first."""
        pairs = zip(self.upper, self.damping_ratios, strict=True)
        rows = [(abs(p) / (2.0 * np.pi), ratio, p.real, p.imag) for p, ratio in pairs]
        undamped = not any(self.damping_ratios)
        zero = ("damping ratio", "real") if undamped else ()
        columns = [replace(column, detail=column.name in zero) for column in POLES]
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
            f"balanced: {self.balanced.order} of {len(self.modal.a)} states; guaranteed error of every "
            f"response: at most {100.0 * self.balanced.bound:.3g} % of its static value at all frequencies, "
            "0 at frequency 0",
            *EXPLANATION,
        )

    def complaints(self) -> list[str]:
        if self.balanced is None or self.balanced.bound <= LOOSE:
            return []
        bound, enough = f"{100.0 * self.balanced.bound:.3g} %", self.balanced.order_within(TIGHT)
        return [
            f"balanced: the error of {self.balanced.order} states may reach {bound} of the static response; "
            f"{enough} states keep it below {100.0 * TIGHT:g} % (--reduce balanced:{TIGHT:g})"
        ]


def unit_of(name: str) -> str:
    """Return the unit of an input by its name's last word; "factor" for the scene's loads and gravity."""
    return UNITS.get(name.replace(".", " ").split()[-1], "factor")


def linearise(
    scene: AnyScene,
    lattice: Lattice = Lattice(),  # noqa: B008  # frozen
    *,
    modes: int | None = MODES,
    reduce: str | None = None,
    about: About = "deformed",
) -> Linearisation:
    """Return a scene's lattice linearised about its equilibrium under its loads, or about the flat sheet.

    modes: largest number of modes in the state space, None for all; reduce: "balanced:8" for a reduction to
    8 states, "balanced:0.01" for the fewest states with an error bound of 0.01 of the static response.
    Raises BadInput for unknown choices, for a scene without linear form (`lumped.linearise`) and a state
    space that cannot be balanced (`lumped.StateSpace`).
    """
    import lumped

    scene = scene_of(scene)
    if modes is not None and modes < 1:
        raise BadInput(f"modes = {modes}: at least 1")
    order, tolerance = _balance(reduce)
    model = resolve(scene, lattice, "motion")
    springs = model.springs
    context().progress(Work("linearising the lattice", model.size))
    matrices = lumped.linearise(scene, springs, about)
    unknowns = matrices.mass.shape[0]
    require_states(2 * min(modes or unknowns, unknowns))
    space = matrices.state_space(None if modes is None else min(modes, unknowns))
    balanced = None if reduce is None else space.balanced(order, tolerance)
    return Linearisation(scene, f"lumped {springs.title}", about, matrices, space, balanced)


def _balance(reduce: str | None) -> tuple[int | None, float | None]:
    """Return the order of "balanced:8" or the tolerance of "balanced:0.01", both None for None."""
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
