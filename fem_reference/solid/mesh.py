"""Plan mesh of quadrilaterals, extruded into layers of 27-node bricks: columns of nodes over plan nodes.

Node (plan node j, level l) has the number j · levels + l, with 2 · layers + 1 levels from the bottom face to
the top one; the middle level is the mid-surface. Through the thickness the fields are piecewise quadratic,
N_l(ζ), and two averages of a column stand for the sheet as a surface:

    mean x̄ = 1/h ∫ x dζ        director D = 12/h³ ∫ ζ x dζ        (flat: the plan point and e_z)

Coordinates in metres.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from skfem import ElementHex2, ElementQuad2, MeshQuad

from fem_reference.solid.materials import LAWS
from fem_reference.surface.biquadratic import AT_GAUSS, jacobians, require_upright
from fem_reference.surface.mesh import Plan, plan_of, quarters
from fem_reference.surface.rubber import require_law
from sheetbench.answers.solution import FieldMesh
from sheetbench.choices import STRAIN_LAW
from sheetbench.errors import BadInput
from sheetbench.scenes import Constants, EdgeLoad, Material, Pressure, Scene, require_uniform
from sheetbench.scenes.meaning.composition import constants_at, of_sheet
from sheetbench.scenes.objects.orthotropy import Ply, impossible_in_space

MOST_BRICKS = 12  # through the thickness of a laminate


@dataclass(frozen=True)
class Columns:
    """Columns of nodes over n plan nodes, extruded to a thickness [m] in layers. taper: thickness of each
    column over the sheet's, (n,), or 1."""

    plan: Plan
    thickness: float
    layers: int
    taper: np.ndarray

    @property
    def levels(self) -> int:
        return 2 * self.layers + 1

    @cached_property
    def heights(self) -> np.ndarray:
        """Heights z (levels,) [m] of the levels, in columns of the sheet's thickness."""
        return np.linspace(-0.5, 0.5, self.levels) * self.thickness

    @cached_property
    def positions(self) -> np.ndarray:
        """Positions (n, levels, 3) [m] of the nodes by column."""
        out = np.zeros((len(self.plan.nodes), self.levels, 3))
        out[:, :, :2] = self.plan.nodes[:, None]
        out[:, :, 2] = np.multiply.outer(self.taper, self.heights)
        return out

    @cached_property
    def averages(self) -> np.ndarray:
        """Weights (2, levels) of mean and director in a column's positions (Simpson's rule)."""
        share = np.tile([2.0, 4.0], self.layers + 1)[: self.levels]
        share[[0, -1]] = 1.0
        share /= share.sum()
        return np.array([share, 12.0 / self.thickness**2 * self.heights * share])

    @cached_property
    def stacks(self) -> np.ndarray:
        """Nodes of the bricks over every plan element, (m, 9 · levels), by column."""
        nodes = self.levels * self.plan.elements[:, :, None] + np.arange(self.levels)
        return nodes.reshape(len(nodes), -1)

    @cached_property
    def places(self) -> np.ndarray:
        """Indices (layers, 27) of the bricks' nodes within a stack, in the order of `ElementHex2`."""
        flat = {tuple(site): i for i, site in enumerate(ElementQuad2.doflocs)}
        column = np.array([flat[tuple(site[:2])] for site in ElementHex2.doflocs])
        level = np.rint(2.0 * ElementHex2.doflocs[:, 2]).astype(int)
        return np.array([self.levels * column + level + 2 * layer for layer in range(self.layers)])

    @property
    def bricks(self) -> np.ndarray:
        """Nodes of all bricks (layers · m, 27), layer by layer."""
        return self.stacks[:, self.places].swapaxes(0, 1).reshape(-1, 27)

    def field_mesh(self, displacement: np.ndarray) -> FieldMesh:
        """Return nodes and trilinear eighths of the bricks, with displacement (n, levels, 3) [m]."""
        plan = quarters(self.plan.elements.T)
        a, b, _, d = (self.plan.nodes[plan[:, corner]].T for corner in range(4))
        clockwise = (b - a)[0] * (d - a)[1] < (b - a)[1] * (d - a)[0]  # as scikit-fem numbers some meshes
        base = self.levels * np.where(clockwise[:, None], plan[:, ::-1], plan)
        cells = [np.concatenate([base + level, base + level + 1], axis=1) for level in range(self.levels - 1)]
        blocks, fields = (
            [("hexahedron", np.concatenate(cells))],
            {"displacement": displacement.reshape(-1, 3)},
        )
        return FieldMesh(self.positions.reshape(-1, 3), blocks, fields)


def _require_meshable(scene: Scene, law: str) -> None:
    """Raise BadInput for steps in thickness, and for nonuniform sheets with another law or follower loads."""
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
                "choose shell or plate"
            )
    if law != STRAIN_LAW:
        require_uniform(scene, f"the solid's law '{law}'", f"its law '{STRAIN_LAW}' is for all sheets")
    if taper and (scene.actuators or any(isinstance(load, Pressure | EdgeLoad) for load in scene.loads)):
        raise BadInput(
            "sheet.taper_x, sheet.taper_y: the solid takes tapered sheets under weight and point loads; "
            "choose the shell"
        )


def bricks_through(scene: Scene, layers: int) -> int:
    """Return the number of bricks through the thickness: as requested, or the next with faces between all
    plies. Raises BadInput for a laminate that needs more than `MOST_BRICKS`."""
    if not scene.layers:
        return layers
    plies = of_sheet(scene).plies
    between = np.array([ply.low - plies[0].low for ply in plies])
    for count in range(layers, MOST_BRICKS + 1):
        if np.allclose(count * between, np.rint(count * between), rtol=0.0, atol=1e-6):
            return count
    raise BadInput(
        f"layer: up to {MOST_BRICKS} equal bricks through the thickness have no faces between all layers; "
        "choose plate, shell or lattice"
    )


def _constants_of_bricks(scene: Scene, middles: np.ndarray, layers: int) -> Constants:
    """Return the constants of bricks; in a laminate each brick has the constants of its ply. middles (layers
    · m, 1, 2) [m]: centres of their plan elements, layer by layer."""
    constants = constants_at(scene, middles)
    if not scene.layers:
        return constants
    heights = (np.arange(layers) + 0.5) / layers - 0.5
    ply_at = [next(ply for ply in constants.plies if ply.low <= at <= ply.high) for at in heights]
    each = len(middles) // layers
    values: list[Any] = [np.repeat(column, each)[:, None] for column in zip(*ply_at, strict=True)]
    ply = Ply(*values)
    return constants.replace(plies=(ply._replace(low=-0.5, high=0.5),), density=ply.density)


def columns_of(mesh: MeshQuad, scene: Scene, layers: int, law: str) -> tuple[Columns, Material | Constants]:
    """Return the columns of a scene's solid over a mesh, and the material or constants of its bricks."""
    plan, sheet, taper = plan_of(mesh), scene.sheet, np.ones(())
    require_upright(np.linalg.det(jacobians(plan.corners, AT_GAUSS[1])))
    require_law(law, LAWS, scene)
    if layers < 1:
        raise BadInput(f"layers = {layers}: at least one through the thickness")
    _require_meshable(scene, law)
    layers = bricks_through(scene, layers)
    if sheet.taper_x or sheet.taper_y:
        taper = sheet.thickness_at(*plan.nodes.T) / sheet.thickness
    columns = Columns(plan, sheet.thickness, layers, taper)
    if scene.uniform:
        return columns, scene.material
    middles = np.tile(columns.plan.corners.mean(axis=1), (layers, 1))[:, None]
    return columns, _constants_of_bricks(scene, middles, layers)
