"""The answer of a static model: status, displacement anywhere on the sheet, reactions, energies, timings.

It holds no mechanics, so that both solvers and any plug-in can use it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

import numpy as np

from sheetbench.answers.answer import Answer
from sheetbench.answers.balance import Balance
from sheetbench.answers.contact import ContactState
from sheetbench.answers.report import RASTER, Picture, Write
from sheetbench.answers.table import MILLIMETRES, MILLISECONDS, NEWTONS, NUMBER, Table
from sheetbench.errors import BadInput, NoEquilibrium
from sheetbench.scenes.language import summary
from sheetbench.scenes.objects.quantities import PlanPoint

if TYPE_CHECKING:
    import meshio
    import pyvista

    from sheetbench.scenes.scene import Scene

About = Literal["flat", "deformed"]  # state about which a sheet oscillates: flat, or its equilibrium


_FINER = "more masses (--lumped) or elements (--elements) may help, or a lighter load"
_KEPT = f"{_FINER}; the answer is of the last converged load"


class Status(StrEnum):
    """The end of a solve, with a sentence, its `advice`, on the event and a remedy."""

    advice: str

    def __new__(cls, text: str, advice: str = "") -> Self:
        """Make a status of its text and its advice."""
        status = str.__new__(cls, text)
        status._value_, status.advice = text, advice
        return status

    CONVERGED = "converged", "a stable equilibrium"
    UNSTABLE = (
        "unstable",
        "an equilibrium, but not a stable one: a disturbed sheet moves on to another, which "
        "`compare --branch buckled` seeks",
    )
    SINGULAR = "singular", "the tangent is singular: a limit point, a bifurcation or an unresisted motion"
    STEP_LIMIT = "step-limit", f"no equilibrium within the steps allowed: {_KEPT}"
    DIVERGED = "diverged", f"no equilibrium found: {_KEPT}"
    NON_FINITE = "non-finite", "a number overflowed: check the magnitudes of loads and stiffnesses"
    INVERTED = "inverted", f"a cell or an element turned inside out: {_FINER}"
    STRAIN_OUTSIDE_MODEL = (
        "strain-outside-model",
        "strains or rotations beyond the model's limits: not physical",
    )
    REFUSED = "refused", "the model does not support the scene"
    FAILED = "failed", "a program or a mesh failed: there is no answer"


COMPONENTS = ("ux", "uy", "uz")
STEP = 1e-5  # of the largest displacement, for differences of a function of displacements


def comparable(status: str, load_factor: float) -> bool:
    """Return whether an answer may be compared with others by its status and load factor. It must be an
    equilibrium under the whole load, stable and physical or not."""
    return status in _EQUILIBRIA and load_factor == 1.0


_EQUILIBRIA = (Status.CONVERGED, Status.UNSTABLE, Status.STRAIN_OUTSIDE_MODEL)


@dataclass(frozen=True)
class Iteration:
    """One equilibrium iteration: load factor, residual relative to the forces, step length [m]."""

    load_factor: float
    residual: float
    step: float


@dataclass(frozen=True)
class FieldMesh:
    """A mesh with fields, ready to be written as VTU.

    points: (n, 3) [m] undeformed; cells: meshio type → (m, k) connectivity; point_data: name → (n, …),
    always with "displacement" (n, 3) [m]; cell_data: name → one array per cell block, in order."""

    points: np.ndarray
    cells: list[tuple[str, np.ndarray]]
    point_data: dict[str, np.ndarray]
    cell_data: dict[str, list[np.ndarray]] = field(default_factory=dict)

    def to_meshio(self) -> meshio.Mesh:
        """Convert to `meshio.Mesh`."""
        import meshio

        return meshio.Mesh(self.points, self.cells, self.point_data, self.cell_data)

    def save(self, path: str | Path) -> None:
        """Write the mesh in the format of the path's suffix: .vtu, .vtk, .xdmf, …"""
        self.to_meshio().write(path)

    def __repr__(self) -> str:
        cells = ", ".join(f"{len(block)} {kind}" for kind, block in self.cells)
        fields = ", ".join([*self.point_data, *self.cell_data])
        return f"FieldMesh of {len(self.points)} points and {cells} with {fields}"


@dataclass(frozen=True)
class CostRow:
    """Cost of a solve [s], and the largest displacement [m]."""

    unknowns: Annotated[int, NUMBER("d")]
    factorisations: Annotated[int, NUMBER("d")]
    setup: Annotated[float, MILLISECONDS(".3g", "set-up")]
    solve: Annotated[float, MILLISECONDS(".3g")]
    largest: Annotated[float, MILLIMETRES(".4g", "largest displacement")]


@dataclass(frozen=True)
class ProbeRow:
    """Displacement of the mid-surface at a probe [m]."""

    probe: str
    ux: Annotated[float, MILLIMETRES("z.3f")]
    uy: Annotated[float, MILLIMETRES("z.3f")]
    uz: Annotated[float, MILLIMETRES("z.3f")]


@dataclass(frozen=True)
class ReactionRow:
    """Force of a support on the sheet [N]."""

    edge: str
    x: Annotated[float, NEWTONS("z.4f", "Fx")]
    y: Annotated[float, NEWTONS("z.4f", "Fy")]
    z: Annotated[float, NEWTONS("z.4f", "Fz")]


DOCUMENTED = (  # fields that the JSON document has unchanged
    "model", "label", "settings", "message", "stretch", "load_factor", "unknowns", "iterations",
    "solve_seconds", "setup_seconds", "reactions", "energies",
)  # fmt: skip


@dataclass(frozen=True, repr=False)
class Solution(Answer):
    """A model's answer to a static scene.

    Parameters
    ----------
    model, label : str
        The model's name, and the model in words.
    settings : dict
        The model's settings.
    status : Status
        The end of the solve; an equilibrium out of balance becomes `diverged`.
    unknowns, iterations : int
        Number of unknowns, and of all factorisations of the tangent.
    setup_seconds, solve_seconds : float [s]
        Time for the set-up and for the solve.
    sample : callable
        Plan points (n, 2) [m] → mid-surface displacement (n, 3) [m].
    reactions : dict of str to ndarray, (3,) [N]
        Force of each support or prescribed motion on the sheet by its edge, of a held base on its chain by
        "EDGE base", of an obstacle by its name.
    energies : dict of str to float [J]
        Energies by name.
    mesh : FieldMesh
        The mesh with the displacement, for files.
    history : tuple of Iteration, optional
        Iterations of the solve.
    load_factor : float, optional
        1 if the full load was reached, else the last converged load.
    actuators : dict of str to ndarray, (segments, 6) [N, N·m], optional
        Force and moment of each segment of an actuator on the sheet.
    balance : Balance, optional
        Residual of all forces, None if a model does not report it.
    snaps : tuple of float, optional
        Load factors at which the sheet left its load path for an equilibrium far away.
    fallback : str, optional
        A clause on a method used in place of the requested one.
    remarks : tuple of str, optional
        Further clauses.
    stretch : float, optional
        Largest elongation of the mid-surface, None if a model does not report it.
    points : dict of str to (float, float) [m], optional
        Plan points of the scene's probes by name.
    contacts : dict of str to ContactState, optional
        Contact with each obstacle by the obstacle's name.
    sensitivity : callable, optional
        Makes the derivatives of the equilibrium (`names`, `at_points`, `pullback`, `pushforward`), None for
        a model without derivatives.
    """

    file_name = "solution"
    model: str
    label: str
    settings: dict[str, Any]
    status: Status
    unknowns: int
    iterations: int
    setup_seconds: float
    solve_seconds: float
    sample: Callable[[np.ndarray], np.ndarray]
    reactions: dict[str, np.ndarray]
    energies: dict[str, float]
    mesh: FieldMesh
    history: tuple[Iteration, ...] = ()
    load_factor: float = 1.0
    actuators: dict[str, np.ndarray] = field(default_factory=dict)
    balance: Balance | None = None
    snaps: tuple[float, ...] = ()
    fallback: str = ""
    remarks: tuple[str, ...] = ()
    stretch: float | None = None
    points: dict[str, PlanPoint] = field(default_factory=dict)
    contacts: dict[str, ContactState] = field(default_factory=dict)
    sensitivity: Callable[[], Any] | None = None

    def __post_init__(self) -> None:
        if self.status in _EQUILIBRIA and self.balance is not None and not self.balance.holds:
            object.__setattr__(self, "status", Status.DIVERGED)
            object.__setattr__(self, "remarks", (self.balance.in_words(), *self.remarks))

    @property
    def message(self) -> str:
        """Return fallback, snaps, remarks and notes on contacts in a line."""
        snapped = (f"snapped at load factor {load_factor:.4g}" for load_factor in self.snaps)
        contacts = (f"{name}: {note}" for name, one in self.contacts.items() for note in one.notes)
        return "; ".join(filter(None, [self.fallback, *snapped, *self.remarks, *contacts]))

    @property
    def status_text(self) -> str:
        """Return the status, with the reached share of the load unless it is the whole load."""
        reached = "" if self.load_factor == 1.0 else f" at {100 * self.load_factor:.3g} % of the load"
        return f"{self.status}{reached}"

    def document(self, scene: Scene | None = None) -> dict[str, Any]:
        """Return the JSON document in SI units, with the displacements at a scene's or the own probes."""
        points = self.points if scene is None else scene.probes
        moved = [*self.displacement(np.array([*points.values()]))] if points else []
        return {
            **{name: getattr(self, name) for name in DOCUMENTED},
            "status": str(self.status),
            "advice": self.status.advice,
            "snaps": list(self.snaps),
            "probes": dict(zip(points, moved, strict=True)),
            "contacts": {name: asdict(contact) for name, contact in self.contacts.items()},
            "balance": self.balance.document() if self.balance is not None else None,
        }

    @property
    def touched(self) -> frozenset[str]:
        """Return the names of the obstacles that the sheet touches."""
        return frozenset(name for name, contact in self.contacts.items() if contact.points)

    @property
    def comparable(self) -> bool:
        """Return whether the answer may be compared with others, by the function `comparable`."""
        return comparable(self.status, self.load_factor)

    def require_stable(self) -> Self:
        """Return the answer. Raises NoEquilibrium unless it is a stable equilibrium under the whole load."""
        if self.status is not Status.CONVERGED or not self.comparable:
            raise NoEquilibrium(f"{self.label}: {self.status}: {self.message or self.status.advice}")
        return self

    @property
    def probes(self) -> dict[str, np.ndarray]:
        """Return the displacement (3,) [m] at each of the scene's probes, by name."""
        return {name: self.displacement(np.array([at]))[0] for name, at in self.points.items()}

    def displacement(self, points: np.ndarray | str) -> np.ndarray:
        """Return the mid-surface displacement (n, 3) [m] at plan points (n, 2) [m], or (3,) at a probe.
        points: of the undeformed sheet, or a probe's name. Raises BadInput for an unknown name."""
        if isinstance(points, str):
            if points not in self.points:
                known = ", ".join(self.points) or "none; give plan points (n, 2) [m]"
                raise BadInput(f"displacement('{points}'): no probe of this name; known: {known}")
            return self.probes[points]
        return self.sample(np.asarray(points, dtype=float).reshape(-1, 2))

    def gradient(
        self,
        of: str | np.ndarray | Callable[[np.ndarray], float],
        by: Sequence[str] | None = None,
        at: np.ndarray | None = None,
    ) -> dict[str, Any]:
        """Return the derivatives of a number J of this equilibrium by parameters, from one adjoint solve: a
        number by a number of the scene, for instance young, patch1.thickness or load1.force.z; an array by a
        field over the model's cells or elements, for instance cells.young or elements.young. Points in
        contact with an obstacle are taken to stay in contact.

        of: a component at a probe, as "P4.uz"; an array (n, 3), J's derivatives by the displacements at the
        probes in their order; or a smooth function of the displacements, (n, 3) [m], that returns J,
        differentiated by central differences. at: plan points (n, 2) [m] in place of the probes. by: names;
        all that there are without it.

        Raises NoEquilibrium where this is no stable equilibrium under the whole load, BadInput for a model
        without derivatives and an unknown name."""
        if self.sensitivity is None:
            raise BadInput(f"gradient: {self.label} has no derivatives; choose lumped, plate or shell")
        self.require_stable()
        points = np.array([*self.points.values()]) if at is None else np.reshape(at, (-1, 2))
        derivatives = self.sensitivity().at_points(points, self._by_displacements(of, points))
        if by is not None:
            return {name: derivatives[name] for name in by}
        every = {}
        for name in derivatives:
            with suppress(BadInput):  # as a clamp's tilt is where another one shares its corner
                every[name] = derivatives[name]
        return every

    def _by_displacements(self, of: Any, points: np.ndarray) -> np.ndarray:
        """Return ∂J/∂u (n, 3) at plan points."""
        if isinstance(of, str):
            probe, _, component = of.rpartition(".")
            if probe not in self.points or component not in COMPONENTS:
                raise BadInput(f"gradient: of = '{of}': a probe and ux, uy or uz, as 'P4.uz', is needed")
            out = np.zeros((len(points), 3))
            out[[*self.points].index(probe), COMPONENTS.index(component)] = 1.0
            return out
        if callable(of):
            u = self.displacement(points)
            h = STEP * np.abs(u).max()
            units = h * np.eye(u.size).reshape(-1, *u.shape)
            return np.array([(of(u + e) - of(u - e)) / (2.0 * h) for e in units]).reshape(u.shape)
        given = np.asarray(of, dtype=float)
        if given.shape != (len(points), 3):
            raise BadInput(f"gradient: of: shape {given.shape}; ({len(points)}, 3) is needed")
        return given

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """Convert the undeformed mesh with its fields to pyvista, with `displacement` as active vectors.
        `solution.to_pyvista().warp_by_vector().plot()` draws the deformed sheet."""
        import pyvista

        grid = pyvista.from_meshio(self.mesh.to_meshio())
        grid.set_active_vectors("displacement")
        return grid

    def heading(self) -> tuple[str, str, str]:
        return f"Solution of {self.label}", self.status_text, ""

    def tables(self) -> tuple[Table, ...]:
        """Return tables of the cost, of the probes' displacements and of the supports' forces."""
        u = self.mesh.point_data.get("displacement", np.zeros((1, 3)))
        largest = float(np.max(np.linalg.norm(u, axis=1)))
        cost = CostRow(self.unknowns, self.iterations, self.setup_seconds, self.solve_seconds, largest)
        probes = [ProbeRow(name, *u) for name, u in self.probes.items()]
        forces = [ReactionRow(name, *f) for name, f in summary.without_rounding(self.reactions).items()]
        tables = (
            Table.of(CostRow, [cost], "Cost and largest displacement", "solution"),
            Table.of(ProbeRow, probes, "Displacement of the mid-surface", "probes"),
            Table.of(ReactionRow, forces, "Force of each support on the sheet", "reactions"),
        )
        return tuple(table for table in tables if table.rows)

    def figures(self) -> tuple[Picture, ...]:
        """Return the figure of heights over the plan."""
        compose = "sheetbench.answers.solution_figure:compose"
        return (Picture("solution", compose, (self,), formats=RASTER),)

    def files(self) -> dict[str, Write]:
        return {f"{self.model}.vtu": self.mesh.save}

    def notes(self) -> list[str]:
        energies = ", ".join(f"{name} {value:.4g} J" for name, value in self.energies.items())
        return [text for text in (f"energies: {energies}" if energies else "", self.message) if text]

    def complaints(self) -> list[str]:
        return [] if self.succeeded else [f"{self.status_text}: {self.status.advice}"]

    def choices(self) -> dict[str, Any]:
        return self.settings

    @property
    def succeeded(self) -> bool:
        return self.status is Status.CONVERGED
