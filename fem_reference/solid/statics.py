"""Geometrically nonlinear three-dimensional solid: the sheet without a plate theory's assumptions.

    ∫ S(E) : δE dV = δ(loads),    E = ½ (Fᵀ F − 1)

total Lagrangian, St Venant–Kirchhoff (default), Biot or a rubber's (`materials`), on 27-node bricks that lock
neither in a thin sheet nor as ν → ½ (`element`), in one layer or more. Displacements are the
mid-surface's.

At every edge the solid has a layer as wide as the sheet is thick: at a free one the twisting stress turns
round, at a clamp the Poisson contraction is stopped. On a uniform mesh much coarser than that, answers
converge like 1/n (a full clamp's stress is singular besides): the mesh is graded towards the edges. The
default clamp is a shell's (`supports`). Actuators are the shell's rods and motions (`rods`). SI
units.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from skfem import MeshQuad

from fem_reference.solid import supports as column_supports
from fem_reference.solid.balance import balance
from fem_reference.solid.element import Bricks
from fem_reference.solid.materials import LAWS
from fem_reference.solid.mesh import Columns
from fem_reference.solid.natural import NaturalBricks
from fem_reference.solid.rods import DIRECTORS, on_columns
from fem_reference.solid.structure import Forces, SolidStructure, State
from fem_reference.surface import loads, rod
from fem_reference.surface.actuator_forces import Held, OnEdge, exerted
from fem_reference.surface.borders import borders_of
from fem_reference.surface.mesh import Elements, divisions, has_lines, mesh_of, require_upright
from fem_reference.surface.rubber import limit_notes, require_law
from fem_reference.surface.stretch import largest_stretch
from sheetbench.choices import STRAIN_LAW
from sheetbench.clock import now
from sheetbench.errors import BadInput
from sheetbench.numerics.continuation.path import Fault, Path, Progress
from sheetbench.numerics.continuation.trace import trace_path
from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import (
    Constants,
    EdgeLoad,
    Pressure,
    Scene,
    Solution,
    Status,
    outside_model,
    require_uniform,
)
from sheetbench.scenes.orthotropy import Ply, impossible_in_space
from sheetbench.scenes.patches import constants_at, of_sheet, require_flat_at_rest
from sheetbench.scenes.rigid_motions import require_static

GRADINGS = ("edges", "uniform")
MOST_BRICKS = 12  # through the thickness of a laminate


def solve(
    scene: Scene,
    elements: Elements = 16,
    layers: int = 1,
    law: str = STRAIN_LAW,
    clamp: str = "shell-like",
    grading: str = "edges",
    *,
    progress: Progress | None = None,
) -> Solution:
    """The static equilibrium of a scene; elements along the shorter side (near-square), or (nx, ny).

    layers: bricks through the thickness; law: a key of `LAWS`; clamp: one of `supports.CLAMPS`; grading: one
    of `GRADINGS`; progress: called once an iteration.
    Raises scenes.SceneError if the supports leave a rigid motion free, BadInput for an unknown option.
    """
    require_static(scene)
    along_x, along_y = divisions(scene.sheet, elements)
    mesh = plan_mesh(scene, (along_x, along_y), grading)
    requested = {"elements": [along_x, along_y], "grading": grading}
    layers = bricks_through(scene, layers)
    label = f"solid {along_x} × {along_y} × {layers}"
    return _solved(mesh, scene, label, requested, layers, law, clamp, progress=progress)


def solve_on(mesh: MeshQuad, scene: Scene) -> Solution:
    """Return the equilibrium on columns over any flat mesh of straight-sided quadrilaterals [m]."""
    return _solved(mesh, scene, "solid", {"elements": mesh.nelements}, own=True)


def _solved(
    mesh: MeshQuad,
    scene: Scene,
    label: str,
    requested: dict[str, Any],
    layers: int = 1,
    law: str = STRAIN_LAW,
    clamp: str = "shell-like",
    own: bool = False,
    progress: Progress | None = None,
) -> Solution:
    """own: whether the mesh has an outline of its own, in place of the scene's sheet."""
    begin = now()
    structure = discretise(mesh, scene, layers, law, clamp)
    solver = DirectSolver(structure.symmetric)
    ready = now()
    path = trace_path(structure, solver, partial(inspected, structure), progress=progress)
    structure.bricks.grow(path.load_factor)
    done = now()

    columns, displacement = structure.columns, path.state.displacement
    status, notes, stretch = judge(scene, structure, path, law)
    forces = structure.forces(path.state, path.load_factor)
    middle = (columns.positions + displacement)[:, columns.layers]
    held = Held(columns.about_middle(displacement, forces.residual), middle)
    edges = _on_edges(structure, path.state, forces, middle)
    wrenches, _ = exerted(scene, edges, structure.supports.line.moved, held)
    of_rods = {"rod": structure.rod_energy(path.state)} if scene.actuators else {}
    return Solution(
        model="solid",
        label=label,
        settings={**requested, "layers": layers, "law": law, "clamp": clamp},
        status=status,
        unknowns=structure.unknowns,
        iterations=path.factorisations,
        setup_seconds=ready - begin,
        solve_seconds=done - ready,
        sample=partial(columns.sample, displacement),
        reactions=structure.supports.reactions(forces.residual, path.load_factor),
        energies=structure.energies(path.state) | of_rods,
        mesh=columns.field_mesh(displacement),
        history=tuple(path.history),
        load_factor=path.load_factor,
        actuators=wrenches,
        balance=balance(scene, structure, path, forces, edges, own),
        remarks=(*notes, *limit_notes(law, scene.material, status)),
        stretch=stretch,
    )


def judge(
    scene: Scene, structure: SolidStructure, path: Path[State, Forces], law: str
) -> tuple[Status, list[str], float]:
    """Return status and notes of a path that has ended, strains beyond the law among them, and the stretch of
    the mid-surface."""
    status, notes = path.status, path.notes
    stretch = largest_stretch(*(structure.mid_surface(at) for at in (0.0, path.state.displacement)))
    outside = "" if LAWS[law].stands_any_strain else outside_model(scene, stretch)
    if outside and status is not Status.NON_FINITE:
        status, notes = Status.STRAIN_OUTSIDE_MODEL, [outside, *notes]
    return status, notes, stretch


def inspected(structure: SolidStructure, path: Path[State, Forces]) -> Fault | None:
    """Return why a step of the path is given up: a brick that has turned inside out."""
    inside_out = structure.inside_out(path.state)
    return Fault(Status.INVERTED, "a brick has turned inside out: use more elements") if inside_out else None


def _on_edges(structure: SolidStructure, state: State, forces: Forces, middle: np.ndarray) -> list[OnEdge]:
    """What the rods exert on the columns of their edges, whose middles are at (n, 3) [m]."""
    found, first = [], 0
    rods = structure.rods
    for one, pull in zip(rods.rods, rods.by_rod(forces.rods.pull), strict=True):
        nodal, count = np.zeros_like(state.displacement), len(one.line)
        np.subtract.at(nodal, one.nodes, pull[:, :-DIRECTORS].reshape(*one.nodes.shape, -1, 3))
        about = structure.columns.about_middle(state.displacement, nodal)
        director = (state.aside + rods.own)[first : first + count]
        found.append(OnEdge(one, about[one.line], middle[one.line], director))
        first += 3 * count
    return found


def _require_meshable(scene: Scene, law: str) -> None:
    """Raise BadInput for a sheet with a step in its thickness, or one that is not the same all over and has
    another law, or loads that follow it."""
    if scene.uniform:
        return
    for ply in of_sheet(scene).plies:
        if wrong := impossible_in_space(ply):
            raise BadInput(f"{'layer' if scene.layers else 'material'}.{wrong}")
    taper = scene.sheet.taper_x or scene.sheet.taper_y
    for number, patch in enumerate(scene.patches, start=1):
        if patch.thickness is not None and (taper or patch.thickness != scene.sheet.thickness):
            raise BadInput(
                f"patch {number}.thickness = {patch.thickness:g} m: the solid has no steps in its thickness; "
                "the shell and the plate have"
            )
    if law != STRAIN_LAW:
        require_uniform(scene, f"the solid's law '{law}'", f"its law '{STRAIN_LAW}' is for others too")
    if taper and (scene.actuators or any(isinstance(load, Pressure | EdgeLoad) for load in scene.loads)):
        raise BadInput(
            "sheet.taper_x, sheet.taper_y: the solid has tapered sheets under weight and point loads alone; "
            "the shell has others too"
        )


def bricks_through(scene: Scene, layers: int) -> int:
    """Return how many bricks there are through the thickness: as many as requested, of a laminate at least so
    many, with faces between all plies. Raises BadInput where those are too many."""
    if not scene.layers:
        return layers
    plies = of_sheet(scene).plies
    between = np.array([ply.low - plies[0].low for ply in plies])
    for count in range(layers, MOST_BRICKS + 1):
        if np.allclose(count * between, np.rint(count * between), rtol=0.0, atol=1e-6):
            return count
    raise BadInput(
        f"layer: the solid has {MOST_BRICKS} bricks of one height at most through its thickness, and no such "
        "number has a face between all layers; plate, shell and lattice have them"
    )


def _constants_of_bricks(scene: Scene, middles: np.ndarray, layers: int) -> Constants:
    """Return the constants of bricks, of a laminate each those of its ply; middles (layers · m, 1, 2) [m]: of
    their plan elements, layer by layer."""
    found = constants_at(scene, middles)
    if not scene.layers:
        return found
    heights = (np.arange(layers) + 0.5) / layers + found.plies[0].low
    own = [next(ply for ply in found.plies if ply.low <= at <= ply.high) for at in heights]
    values: list[Any] = [np.repeat(each, len(middles) // layers)[:, None] for each in zip(*own, strict=True)]
    ply = Ply(*values)
    return found.replace(plies=(ply._replace(low=-0.5, high=0.5),), density=ply.density)


def plan_mesh(scene: Scene, elements: tuple[int, int], grading: str) -> MeshQuad:
    """The plan mesh; without lines along x and y it has no rows along its rim, for thin curved bricks keep
    corrections from shrinking. Raises BadInput for an unknown grading."""
    if grading not in GRADINGS:
        raise BadInput(f"grading = {grading!r}: known are {', '.join(GRADINGS)}")
    return mesh_of(scene, elements, graded=grading == "edges" and has_lines(borders_of(scene)))


def discretise(
    mesh: MeshQuad,
    scene: Scene,
    layers: int = 1,
    law: str = STRAIN_LAW,
    clamp: str = "shell-like",
) -> SolidStructure:
    """The discrete solid of a scene on a plan mesh of straight-sided quadrilaterals.

    Supports and loads act on the mesh's boundaries of their edges' names; of the scene's sheet only the
    thickness is used. Raises BadInput for an unknown law or clamp, no layers or a folded element.
    """
    require_upright(mesh)
    require_law(law, LAWS, scene.material)
    if layers < 1:
        raise BadInput(f"layers = {layers}: at least one through the thickness")
    _require_meshable(scene, law)
    layers = bricks_through(scene, layers)
    columns = Columns.on(mesh, scene.sheet, layers)
    stacks = columns.positions.reshape(-1, 3)[columns.stacks]
    positions = np.concatenate([stacks[:, place] for place in columns.places])
    middles = np.tile(columns.plan.corners.mean(axis=1), (layers, 1))[:, None]
    material = scene.material if scene.uniform else _constants_of_bricks(scene, middles, layers)
    if law != STRAIN_LAW:
        require_flat_at_rest(scene, f"the solid's law '{law}'")
    bricks = NaturalBricks.of(Bricks.build(positions, LAWS[law], material), scene)
    rods = rod.of_scene(scene, columns.plan)
    supports = column_supports.of_scene(scene, columns, clamp, rods)
    dead, followers = loads.of_scene(scene, columns.plan)
    return SolidStructure(columns, bricks, supports, dead, followers, on_columns(rods, columns))
