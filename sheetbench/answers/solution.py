"""What every model answers with: status, displacement anywhere on the sheet, reactions, energies, timings.

Part of the question's language: it holds no mechanics, so both solvers and any plug-in can use it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self

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

About = Literal["flat", "deformed"]  # what oscillations are about: the sheet at rest, or its equilibrium


_FINER = "more masses (--lumped) or elements (--elements) may help, or a lighter load"
_KEPT = f"{_FINER}; the last converged load is kept"


class Status(StrEnum):
    """How a solve ended, each with a sentence, its `advice`: what happened and what a user can change."""

    advice: str

    def __new__(cls, text: str, advice: str = "") -> Self:
        """Return the status of a text."""
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
        "strains or turns beyond what the model means: not physical",
    )
    REFUSED = "refused", "the model does not support what the scene asks"
    FAILED = "failed", "a program or a mesh failed: there is no answer"


COMPONENTS = ("ux", "uy", "uz")
STEP = 1e-5  # of the largest displacement, for differences of a function of displacements


def comparable(status: str, load_factor: float) -> bool:
    """Whether an answer that ended so may be compared with others: an equilibrium under the whole load,
    stable and physical or not."""
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
    always with "displacement" (n, 3) [m]; cell_data: name → one array per cell block, in order.
    """

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


COST = (
    *(NUMBER("d", "unknowns"), NUMBER("d", "factorisations"), MILLISECONDS(".3g", "set-up")),
    *(MILLISECONDS(".3g", "solve"), MILLIMETRES(".4g", "largest displacement")),
)
MOVED = ("probe", *(MILLIMETRES("z.3f", f"u{axis}") for axis in "xyz"))
HELD = ("edge", *(NEWTONS("z.4f", f"F{axis}") for axis in "xyz"))
DOCUMENTED = (  # as they are, in the JSON document
    "model", "label", "settings", "message", "stretch", "load_factor", "unknowns", "iterations",
    "solve_seconds", "setup_seconds", "reactions", "energies",
)  # fmt: skip


@dataclass(frozen=True, repr=False)
class Solution(Answer):
    """A model's answer to a static scene.

    sample: plan points (n, 2) [m] → mid-surface displacement (n, 3) [m]; reactions: force (3,) [N] that a
    support or a prescribed motion exerts on the sheet, by its edge, and a held base on its chain, by "EDGE
    base"; energies: name → [J]; iterations: tangent factorisations, all
    of them; load_factor: 1 where the full load was reached, else the last converged load; actuators: name →
    force and moment of each segment on the sheet, (segments, 6) [N, N·m]. balance: what the forces leave
    over, None where a model does not tell; an equilibrium that is out of balance is none, its status
    `diverged`. snaps: load factors at which the
    sheet left its load path for an equilibrium far away; fallback: what was solved in place of what was
    asked, and why; remarks: what else there is to say, a clause each. stretch: the largest elongation of the
    mid-surface, None where a model does not tell. points: plan points [m] of the
    scene's probes by name, as far as a verb knows them. contacts: what is known of the contact with each
    obstacle, whose force on the sheet is among the reactions. sensitivity: makes the derivatives of the
    equilibrium (`names`, `at_points`, `pullback`, `pushforward`), None of a model without.
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
        """Fallback, snaps and remarks in a line, for people."""
        snapped = (f"snapped at load factor {load_factor:.4g}" for load_factor in self.snaps)
        doubts = (f"{name}: {note}" for name, one in self.contacts.items() for note in one.notes)
        return "; ".join(filter(None, [self.fallback, *snapped, *self.remarks, *doubts]))

    @property
    def status_text(self) -> str:
        """The status, with the share of the load that was reached if it is not all of it."""
        reached = "" if self.load_factor == 1.0 else f" at {100 * self.load_factor:.3g} % of the load"
        return f"{self.status}{reached}"

    def document(self, scene: Scene | None = None) -> dict[str, Any]:
        """The JSON document, SI units; probes are the scene's, or else those whose points are known."""
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
        """The names of the obstacles that it touches."""
        return frozenset(name for name, contact in self.contacts.items() if contact.points)

    @property
    def comparable(self) -> bool:
        """Whether it may be compared with others, as `comparable` has it."""
        return comparable(self.status, self.load_factor)

    def require_stable(self) -> Self:
        """Return this answer. Raises NoEquilibrium unless it is a stable equilibrium under the whole load."""
        if self.status is not Status.CONVERGED or not self.comparable:
            raise NoEquilibrium(f"{self.label}: {self.status}: {self.message or self.status.advice}")
        return self

    @property
    def probes(self) -> dict[str, np.ndarray]:
        """Displacement (3,) [m] at each of the scene's probes, by name."""
        return {name: self.displacement(np.array([at]))[0] for name, at in self.points.items()}

    def displacement(self, points: np.ndarray | str) -> np.ndarray:
        """Mid-surface displacement (n, 3) [m] at plan points (n, 2) [m] of the undeformed sheet, or (3,) at
        the probe of a name. Raises BadInput for a name that no probe has."""
        if isinstance(points, str):
            if points not in self.points:
                known = ", ".join(self.points) or "none are kept here: give plan points (n, 2) [m]"
                raise BadInput(f"displacement('{points}'): no probe of this name; known are {known}")
            return self.probes[points]
        return self.sample(np.asarray(points, dtype=float).reshape(-1, 2))

    def gradient(
        self,
        of: str | np.ndarray | Callable[[np.ndarray], float],
        by: Sequence[str] | None = None,
        at: np.ndarray | None = None,
    ) -> dict[str, Any]:
        """Return the derivatives of a number J of this equilibrium, by one more solve: of a number of the
        scene as young, patch1.thickness or load1.force.z a number, of a field over the cells (elements) of
        the model, as cells.young (elements.young), an array; what touches an obstacle goes on touching it.

        of: a component at a probe, as "P4.uz"; an array (n, 3), J's derivatives by the displacements at the
        probes in their order; or a smooth function of these, (n, 3) [m], that returns J, differentiated by
        central differences. at: plan points (n, 2) [m] in place of the probes. by: names; all
        that there are without it.

        Raises NoEquilibrium where this is no stable equilibrium under the whole load, BadInput for a model
        without derivatives and an unknown name.
        """
        if self.sensitivity is None:
            raise BadInput(f"gradient: {self.label} has no derivatives; lumped, plate and shell have")
        self.require_stable()
        points = np.array([*self.points.values()]) if at is None else np.reshape(at, (-1, 2))
        found = self.sensitivity().at_points(points, self._by_displacements(of, points))
        if by is not None:
            return {name: found[name] for name in by}
        every = {}
        for name in found:
            with suppress(BadInput):  # as a clamp's tilt is where another one shares its corner
                every[name] = found[name]
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
            raise BadInput(f"gradient: of: shape {given.shape}, and there are {len(points)} points: (n, 3)")
        return given

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """The undeformed mesh with its fields, `displacement` as the active vectors, for pyvista:
        `solution.to_pyvista().warp_by_vector().plot()`."""
        import pyvista

        grid = pyvista.from_meshio(self.mesh.to_meshio())
        grid.set_active_vectors("displacement")
        return grid

    def heading(self) -> tuple[str, str, str]:
        return f"Solution of {self.label}", self.status_text, ""

    def tables(self) -> tuple[Table, ...]:
        """What it cost and how far it goes, displacement at the scene's probes, forces of the supports."""
        u = self.mesh.point_data.get("displacement", np.zeros((1, 3)))
        largest = float(np.max(np.linalg.norm(u, axis=1)))
        cost = (self.unknowns, self.iterations, self.setup_seconds, self.solve_seconds, largest)
        moved = [(name, *u) for name, u in self.probes.items()]
        held = [(name, *f) for name, f in summary.without_rounding(self.reactions).items()]
        return (
            Table.listed("Cost and largest displacement", COST, [cost], "solution"),
            *([Table.listed("Displacement of the mid-surface", MOVED, moved, "probes")] if moved else []),
            *([Table.listed("Force of each support on the sheet", HELD, held, "reactions")] if held else []),
        )

    def figures(self) -> tuple[Picture, ...]:
        """Heights over the plan."""
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
