"""Geometrically nonlinear Reissner–Mindlin shell of the flat sheet: large displacements and rotations.

Position φ + ζ d with a unit director d at every node; membrane, bending and transverse-shear energies of
a plane-stress St Venant–Kirchhoff sheet, ½ h E:C:E + h³/24 κ:C:κ + ½ k h G γ·γ with k = 5/6, on nine-node
elements with assumed strains (`shell_element`), under dead and follower loads. Small strains are
assumed, rotations are not; the weight has no couple on the director.
"""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np
from skfem import Basis, ElementQuad2, MeshQuad

from fem_reference.shell import validity as shell_watch
from fem_reference.shell.element import Element, shape
from fem_reference.shell.rods import RoddedShell
from fem_reference.shell.structure import ShellStructure
from fem_reference.solving.equilibrium import trace
from fem_reference.solving.linear import DirectSolver
from fem_reference.solving.pseudo_transient import settler
from fem_reference.surface import actuator_forces, edge_motion, rod
from fem_reference.surface import loads as shell_loads
from fem_reference.surface import supports as shell_supports
from fem_reference.surface.loads import Line
from fem_reference.surface.location import locate
from fem_reference.surface.materials import Section, section_of
from fem_reference.surface.mesh import Elements, divisions, quarters, rectangle
from sheetbench.scenes import FieldMesh, Scene, Solution, Symmetric
from sheetbench.scenes.scene import require_static


def solve(
    scene: Scene, elements: Elements = 16, graded: bool = True, section: Section | None = None
) -> Solution:
    """The static equilibrium of a scene; elements along the shorter side (near-square), or (nx, ny).

    graded: finer towards the edges, uniform otherwise (see `mesh.rectangle`); where the sheet bends more than
    stretched elements stand, it is divided evenly after all, and the message says so. section: stiffness per
    width, from material and thickness unless given. Past limit points under conservative loads the path goes
    on (see `relaxation`), and the message says at which load factors the sheet snapped.
    Raises scenes.SceneError if the supports leave a rigid motion free.
    """
    require_static(scene)
    along_x, along_y = divisions(scene.sheet.lengths, elements)
    begin = perf_counter()
    cuts = [support.edge for support in scene.supports if isinstance(support, Symmetric)]
    settings: dict[str, Any] = {"elements": [along_x, along_y], "graded": graded}
    if section is not None:
        settings["section"] = section._asdict()

    def on(graded: bool) -> Solution:
        mesh = rectangle(scene.sheet, (along_x, along_y), graded, cuts)
        label, asked = f"shell {along_x} × {along_y}", {**settings, "graded": graded}
        return solve_on(mesh, scene, label, asked, begin, section, graded)

    solution = on(graded)
    if not graded or shell_watch.STRETCHED.message not in solution.message:
        return solution
    even = on(False)
    return replace(
        even,
        iterations=solution.iterations + even.iterations,
        setup_seconds=even.setup_seconds - solution.solve_seconds,
        solve_seconds=solution.solve_seconds + even.solve_seconds,
        history=solution.history + even.history,
        message="; ".join(filter(None, ["divided evenly, for it bends much", even.message])),
    )


def solve_on(
    mesh: MeshQuad,
    scene: Scene,
    label: str = "shell",
    settings: dict[str, Any] | None = None,
    begin: float | None = None,
    section: Section | None = None,
    graded: bool = False,
) -> Solution:
    """The same on any flat mesh of quadrilaterals [m], straight-sided (MeshQuad) or biquadratic (MeshQuad2).

    Supports and loads act on the mesh's boundaries of their edges' names ("x0", …), which may lie
    anywhere; of the scene's sheet only the thickness is used, and the lengths of edges with actuators.
    graded: give up where stretched elements bend too much (see `shell_watch`).
    """
    begin = perf_counter() if begin is None else begin
    structure, nodes = discretise(mesh, scene, section)
    solver = DirectSolver(structure.symmetric)
    ready = perf_counter()
    inspect = shell_watch.inspector(scene, structure, solver, graded)
    path = trace(structure, solver, inspect, settler(structure, solver))
    done = perf_counter()
    status, message = shell_watch.judge(scene, structure, path)

    displacement, turn = path.state.change
    forces = structure.forces(path.state, path.load_factor)
    exerted, fields = {}, {}
    if isinstance(structure, RoddedShell):
        exerted = actuator_forces.wrenches(scene, structure, path.state, forces)
        fields = {"actuator_line_force": actuator_forces.line_forces(structure, path.state, forces)}

    def sample(points: np.ndarray) -> np.ndarray:
        return interpolate(mesh, structure.element_nodes, displacement, points)

    return Solution(
        model="shell",
        label=label,
        settings=settings or {"elements": mesh.nelements},
        status=status,
        unknowns=structure.unknowns,
        iterations=path.factorisations,
        setup_seconds=ready - begin,
        solve_seconds=done - ready,
        sample=sample,
        reactions=structure.supports.reactions(forces.residual[0]),
        energies=structure.energies(path.state),
        mesh=field_mesh(
            nodes, structure.element_nodes, displacement, turn + np.array([0.0, 0.0, 1.0]), **fields
        ),
        history=tuple(path.history),
        load_factor=path.load_factor,
        message=message,
        actuators=exerted,
    )


def discretise(
    mesh: MeshQuad, scene: Scene, section: Section | None = None
) -> tuple[ShellStructure, np.ndarray]:
    """The discrete shell of a scene on a mesh, and its nodes' plan positions (n, 2) [m]."""
    basis = Basis(mesh, ElementQuad2())
    nodes, element_nodes = basis.doflocs.T, basis.element_dofs.T
    element = Element.build(
        nodes[element_nodes], section or section_of(scene.material, scene.sheet.thickness)
    )
    on_edge = {str(edge): basis.get_dofs(edge).flatten() for edge in (s.edge for s in scene.supports)}
    supports = shell_supports.of_scene(scene, nodes, on_edge)
    dead, followers = shell_loads.of_scene(scene, mesh, element_nodes, nodes, element.areas)
    if not scene.actuators:
        return ShellStructure(element, element_nodes, supports, dead, followers), nodes
    sides = {}
    for edge in {str(actuator.edge) for actuator in scene.actuators}:
        line = Line.along(mesh, mesh.boundaries[edge], nodes[element_nodes])
        sides[edge] = element_nodes[line.elements[:, None], line.sides]
    supports = edge_motion.hold(supports, scene, nodes, {edge: np.unique(at) for edge, at in sides.items()})
    rods = rod.of_scene(scene, nodes, sides)
    return RoddedShell(element, element_nodes, supports, dead, followers, rods), nodes


def interpolate(
    mesh: MeshQuad, element_nodes: np.ndarray, nodal: np.ndarray, points: np.ndarray
) -> np.ndarray:
    """A nodal field (n, k) at plan points (p, 2) [m]: (p, k). Raises BadInput off the mesh."""
    element, local = locate(mesh, points)
    value, _ = shape(*(2.0 * local - 1.0))
    return np.einsum("pi,pik->pk", value, nodal[element_nodes[element]])


def field_mesh(
    nodes: np.ndarray,
    element_nodes: np.ndarray,
    displacement: np.ndarray,
    director: np.ndarray,
    **more: np.ndarray,
) -> FieldMesh:
    """Nodes and bilinear quarters of the elements, with displacement [m], director and more nodal fields."""
    points = np.column_stack([nodes, np.zeros(len(nodes))])
    fields = {"displacement": displacement, "director": director, **more}
    return FieldMesh(points, [("quad", quarters(element_nodes.T))], fields)
