"""Conversion of a scene for another code: parameters, mesh, and the files that the code reads.

Hinges have the coefficient that is best in the scene, as far as a cell of that mesh can be right there, and
without a scene's answer at rest the one whose moduli are nearest to the sheet's. A hinge on a clamp bends
half a square only, and is to be twice as stiff: hinges with weight "height" are where the row beyond the
clamp is next to it, others are given twice the coefficient. Without that a cantilever of n squares is 2/n too
soft.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from math import ceil
from typing import Any

import numpy as np

from comparisons.codes.cell import cell_of
from comparisons.codes.cell_moduli import CellInScene, Parameter, parameters_of, undamped
from comparisons.codes.coefficients import (
    best_hinge,
    layered_springs,
    limit_errors,
    moduli_of,
    nearest,
    tetrahedral_cell,
    triangular_cell,
)
from comparisons.codes.files import OBSTACLES, OWN_MASSES, WRITERS, Problem, files
from comparisons.codes.sheet_mesh import refusal, sheet_mesh, with_layers
from comparisons.codes.table import CODES, Code
from comparisons.models.grids import GridLike
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Write
from sheetbench.answers.table import Table, number
from sheetbench.errors import BadInput, NoEquilibrium, require_choice
from sheetbench.scenes import EDGES, AnyScene, Scene, SceneError, require_static, require_uniform, scene_of
from sheetbench.scenes.meaning.composition import require_flat_at_rest
from sheetbench.scenes.meaning.natural_state import plies_of
from sheetbench.scenes.meaning.words import sheet_in_words
from sheetbench.scenes.objects.layers import resultants
from sheetbench.scenes.objects.supports import Hinged, Point

SQUARES = 8  # along the shorter side
LAYERED = "tetrahedra"
PEAK = 2.0  # shear next to corners, over the mean along held edges
CLAMP_OFFSET = 0.02  # of a square's side, from a clamp to the row beyond it


@dataclass(frozen=True, repr=False)
class CodeSetup(CellInScene):
    """A scene for a code. best: whether the coefficients are the best in the scene; given: parameters of the
    code in place of the ones made of coefficients; named: whether the user named the scene, without which
    there is a sheet alone."""

    code: Code
    squares: int
    best: bool
    given: Mapping[str, float] = field(default_factory=dict)
    named: bool = True

    file_name = "code"

    @property
    def keys(self) -> list[Parameter]:
        """The code's parameters."""
        return parameters_of(self.code, self.coefficients, self.scene)

    @property
    def problem(self) -> Problem:
        """Mesh and parameters, for the files. Raises BadInput for what codes of triangles do not have."""
        keys = {**{key.name: key.value for key in self.keys}, **self.given}
        material, tetrahedra = self.scene.material, None
        near = CLAMP_OFFSET if self.best and self.code.hinge == "height" else 1.0
        flat = sheet_mesh(self.scene, self.squares, self.cell.name, near)
        if self.code.mesh == LAYERED:
            flat, tetrahedra = with_layers(self.scene, flat, self.squares, self.coefficients["layers"])
        stretching = material.young * self.scene.sheet.thickness / (1.0 - material.poisson**2)
        clamp = 2.0 if self.best and self.code.hinge != "height" else 1.0
        return Problem(flat, keys, stretching, tetrahedra, clamp)

    def heading(self) -> tuple[str, str, str]:
        where = f"{self.code.mesh}, {self.squares} squares along the shorter side"
        return (
            f"{self.scene.name if self.named else 'sheet'} for {self.code.title}",
            where,
            sheet_in_words(self.scene.sheet, self.scene.material),
        )

    def tables(self) -> tuple[Table, ...]:
        caption = f"Parameters of {self.code.title}"
        shown = ("name", "value", "unit", "convention")
        return (Table.of(Parameter, self.keys, caption, "parameters", fields=shown),)

    def result(self) -> str:
        """Return the parameters and the remaining error in a phrase."""
        off = "" if self.limit_error is None else f"; {100 * self.limit_error:.1f} % off on the finest mesh"
        return ", ".join(f"{key.name} {number(key.value, '.4g')} {key.unit}" for key in self.keys) + off

    def notes(self) -> list[str]:
        basis = "have the least error in this scene" if self.best else "come nearest to the sheet's moduli"
        notes = list[str]()
        if reason := self._refuse_files():
            notes.append(f"No files for {self.code.title}, the numbers alone: {reason}.")
        elif warning := self._warn_of_depth():
            notes.append(warning)
        if any(isinstance(support, Point) for support in self.scene.supports):
            notes.append(
                "The displacement at a point support diverges as a mesh gets finer: hold a part, "
                "[[support]] with where = { rectangle = … }, for meshes to agree."
            )
        if self.code.mesh == LAYERED and any(isinstance(s, Hinged | Point) for s in self.scene.supports):
            notes.append("Both layers of springs are held: hinged edges and points cannot turn there.")
        if omitted := undamped(self.code, self.scene.material):
            notes.append(f"The scene's damping is left out: {omitted}.")
        notes.append(f"Coefficients of hinges and springs {basis}.")
        if self.limit_error is not None:
            notes.append(
                "Error of an infinitely fine mesh with these coefficients in this scene: "
                f"{100 * self.limit_error:.1f} % of the largest displacement."
            )
        if not self.named:
            notes.append(
                "No SCENE was given to choose the coefficients and compute their error; the files have the "
                "sheet clamped at x0 under its own weight."
            )
        notes.append(f"Limits: {self.code.cannot}.")
        notes.append(f"Source: {self.code.source}.")
        notes.append(f"{self.code.title} ({self.code.licence}): tested by running it.")
        return notes

    def _refuse_files(self) -> str:
        """Return the reason why the code has no files for the scene, "" if it has them."""
        if self.scene.masses and self.code.name not in OWN_MASSES:
            return f"mass: {self.code.title} has one density for all vertices"
        if self.scene.obstacles and self.code.name not in OBSTACLES:
            return f"obstacle: files for {' and '.join(OBSTACLES)} only have it"
        if any(one.kind == "box" for one in self.scene.obstacles):
            return "obstacle: files have no box"
        return refusal(self.scene)

    def _warn_of_depth(self) -> str:
        """Return a warning that two layers of springs are too shallow for the load, "" if they are not.

        A spring from layer to layer rises by the height H over a side l of a square. At a remaining rise s
        its shear is k s (H² − s²)/(2 l²), at most k H³/(3 √3 l²). What hangs from one edge contracts instead.
        """
        supports = [support for support in self.scene.supports if support.edge]
        if self.code.mesh != LAYERED or len(supports) < 2:
            return ""
        mesh, sides, layers = self.problem.mesh, self.scene.sheet.lengths, self.coefficients["layers"]
        borne = self.coefficients["k"] * (layers * self.squares / min(sides)) ** 3 / 27.0**0.5
        free = (mesh.masses[:, None] * mesh.gravity + mesh.forces)[~mesh.held].sum(axis=0)
        held = sum(sides[1 - EDGES[support.edge].normal_axis] for support in supports)
        load = float(np.linalg.norm(free)) / held
        enough = 1 + ceil(self.squares * (PEAK * load / borne) ** (1.0 / 3.0))
        turned = f"its load of {load:.2g} N/m of held edge flips springs between the layers"
        return f"The mesh is too coarse: {turned}; take --grid {enough}." if enough > self.squares + 1 else ""

    def document(self) -> dict[str, Any]:
        return {
            "code": self.code.name,
            "parameters": [{n: v for n, v in vars(key).items() if n != "code"} for key in self.keys],
            "squares": self.squares,
            "coefficients": dict(self.coefficients),
            "limit_error": self.limit_error,
            "message": self.missing,
            **{name: getattr(self.code, name) for name in ("title", "mesh", "cannot", "source", "licence")},
            "run_here": True,
        }

    def files(self) -> dict[str, Write]:
        if self._refuse_files():
            return {}
        texts = files(self.code.name, self.problem)
        return {name: partial(write_text, text=text) for name, text in texts.items()}


def setup(
    scene: AnyScene,
    code: str,
    squares: int = SQUARES,
    *,
    best: bool = True,
    named: bool = True,
    mesh: str | None = None,
    coefficients: Mapping[str, float] | None = None,
    given: Mapping[str, float] | None = None,
) -> CodeSetup:
    """Return a scene's parameters, mesh and files for a code.

    best: whether hinges are those best in the scene; named: whether the user named the scene: without, no
    number is of it. The answer has no error, and a note, for a scene whose sheet has no stable equilibrium.
    mesh: another than the code's own choice; coefficients: taken in place of those found; given: the code's
    own parameters, in place of computed ones. Raises BadInput for an unknown code.
    """
    scene = scene_of(scene)
    require_choice("--for", code, WRITERS)
    reason = (
        f"its numbers are of one isotropic material and thickness{_of_fabric(scene) * (code == 'newton')}"
    )
    require_uniform(scene, f"--for {code}", reason)
    require_flat_at_rest(scene, f"--for {code}")
    row = CODES[code]
    if squares < 2:
        raise BadInput(f"{squares} squares along the shorter side: at least 2")
    spacing = float(min(scene.sheet.lengths)) / squares
    at_rest = named and _has_statics(scene)
    best, missing, given = best and at_rest and not coefficients, "", given or {}
    name, error_left, fixed = mesh or row.mesh, None, dict(coefficients or {})
    if name == LAYERED:
        values = layered_springs(scene, spacing) | fixed
        cell = tetrahedral_cell(spacing, values["layers"])
    else:
        springs = row.elements == "springs"  # it has no membrane but these
        cell = triangular_cell(name, spacing) if springs else cell_of(name, spacing, hinge=row.hinge)
        none = {"lambda_h": 0.0, "mu_h": 0.0} if springs else None
        values = nearest(cell, scene.material, scene.sheet.thickness, none) | fixed
    try:
        if best and name == LAYERED:
            values = layered_springs(scene, spacing, best=True)
            cell = tetrahedral_cell(spacing, values["layers"])
        elif best and (hinge := best_hinge(scene, cell, values)):
            values["hinge"] = hinge
        if at_rest:
            error_left = limit_errors(scene)(moduli_of(cell, {one: values[one] for one in cell.units()}))
    except NoEquilibrium as error:
        best, missing = False, str(error)
    return CodeSetup(scene, cell, values, error_left, missing, row, squares, best and not given, given, named)


def _of_fabric(scene: Scene) -> str:
    """Return a clause with the numbers of Newton's Style3D solver for a homogeneous sheet, else ""."""
    if not scene.homogeneous:
        return ""
    stiffness = resultants(plies_of(scene))[0] * scene.sheet.thickness
    along, across, shear = map(number, np.diag(stiffness).tolist())
    coupled = f", which leaves out A12 = {number(stiffness[0, 1])} N/m" * bool(stiffness[0, 1])
    return f"; Newton's Style3D solver takes tri_aniso_ke = {along}, {across}, {shear} N/m{coupled}"


def squares_of(grid: GridLike) -> int:
    """Return the number of squares for a grid of vertices, 8 for 9. Raises BadInput for another form."""
    if grid is None:
        return SQUARES
    if not str(grid).isdigit():
        raise BadInput(f"--grid {grid}: with --for, vertices along the shorter side, as 9")
    return int(str(grid)) - 1


def _has_statics(scene: Scene) -> bool:
    try:
        require_static(scene)
    except SceneError:
        return False
    return bool(np.any(scene.probe_points()))
