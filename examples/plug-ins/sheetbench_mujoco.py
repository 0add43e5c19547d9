"""MuJoCo's flexible sheets (`flexcomp`, dim 2) as a model: how a general simulator does on our scenes.

The sheet is a grid of vertices, each a body that slides along x, y and z, with MuJoCo's own elasticity of a
flat sheet made from E, ν and h: membrane triangles, and bending between neighbouring ones (`elastic2d`:
"both", or "bend" alone). Nothing of it is calibrated or changed, but vertices have tributary masses in place
of equal ones. A clamp is made of two pinned rows, the edge and one beyond it, which holds the slope to order
of the grid; a hinge of the edge's row alone. The static answer is where dynamics come to rest: implicit steps
(the integrator "discrete") that stop whenever the kinetic energy has passed a peak.

Upright clamps, hinged edges, gravity and point loads; anything else is refused. Needs MuJoCo.
Source: MuJoCo's documentation, "Deformable objects" and the XML reference of `flexcomp`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from time import perf_counter
from typing import Any, ClassVar

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from sheetbench.answers.solution import FieldMesh, Solution, Status
from sheetbench.errors import BadInput
from sheetbench.scenes import EDGES, Clamped, Hinged, PointLoad, Scene
from sheetbench.scenes.objects.grid import near_square
from sheetbench.scenes.objects.quantities import PlanPoint

AT_REST = 1e-8  # displacement, in sides of the sheet, that one more step would add
STEPS = 30_000
FIRST_STEPS = 10  # of which none counts as rest


@dataclass(frozen=True)
class MuJoCo:
    """The plug-in.

    settings: grid, vertices along the shorter side or [nx, ny]; elastic2d; time_step [s] of the way to rest.
    """

    name: str = "mujoco"
    settings: ClassVar[dict[str, Any]] = {"grid": 9, "elastic2d": "both", "time_step": 0.01}

    def solve(self, scene: Scene, settings: Mapping[str, Any]) -> Solution:
        """Return the sheet at rest. Raises BadInput without MuJoCo or for settings it cannot use."""
        try:
            import mujoco
        except ImportError:
            raise BadInput("model = 'mujoco': needs MuJoCo; pip install mujoco") from None
        nx, ny = _shape(scene, settings["grid"])
        if settings["elastic2d"] not in ("both", "bend"):
            raise BadInput(f"elastic2d = '{settings['elastic2d']}': both or bend")
        if why := _refusal(scene):
            return _solution(
                scene, settings, (nx, ny), np.zeros((ny, nx, 3)), Status.REFUSED, why, 0, 0, (0, 0)
            )
        began = perf_counter()
        grid = _Grid(scene, nx, ny)
        model = mujoco.MjModel.from_xml_string(grid.xml(settings))
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        rest = data.flexvert_xpos.copy()
        inside = grid.number(rest)
        bodies = model.flex_vertbodyid
        free = bodies > 0
        model.body_mass[bodies[free]] = grid.masses(rest)[free]
        mujoco.mj_setConst(model, data)
        data.xfrc_applied[bodies[free], :3] = grid.forces(rest)[free]
        ready = perf_counter()
        steps, settled = relax(mujoco, model, data, AT_REST * max(scene.sheet.lengths))
        done = perf_counter()
        displacement = np.zeros((ny, nx, 3))
        displacement.reshape(-1, 3)[inside[inside >= 0]] = (data.flexvert_xpos - rest)[inside >= 0]
        finite = bool(np.isfinite(displacement).all())
        status = Status.NON_FINITE if not finite else Status.CONVERGED if settled else Status.STEP_LIMIT
        seconds = (ready - began, done - ready)
        return _solution(scene, settings, (nx, ny), displacement, status, "", model.nv, steps, seconds)


@dataclass(frozen=True)
class _Grid:
    """nx × ny vertices on the sheet, and a row beyond every clamped edge."""

    scene: Scene
    nx: int
    ny: int

    @property
    def spacing(self) -> np.ndarray:
        return np.array(self.scene.sheet.lengths) / [self.nx - 1, self.ny - 1]

    @property
    def beyond(self) -> dict[str, int]:
        """Rows beyond each edge: one where it is clamped."""
        clamped = {s.edge for s in self.scene.supports if isinstance(s, Clamped)}
        return {edge: int(edge in clamped) for edge in EDGES}

    def xml(self, settings: Mapping[str, Any]) -> str:
        """Return the model as MuJoCo reads it; vertices run with y fastest."""
        extra, (lx, ly) = self.beyond, self.spacing
        count = (self.nx + extra["x0"] + extra["x1"], self.ny + extra["y0"] + extra["y1"])
        first = np.array([-extra["x0"] * lx, -extra["y0"] * ly])
        centre = first + 0.5 * (np.array(count) - 1) * self.spacing
        x, y = np.meshgrid(np.arange(count[0]), np.arange(count[1]), indexing="ij")
        pinned = np.zeros(count, dtype=bool)
        for support in self.scene.supports:
            row = self._row(support.edge, x - extra["x0"], y - extra["y0"])
            pinned |= row >= 0
        gravity = np.zeros(3)
        if self.scene.gravity is not None:
            gravity = np.array(self.scene.gravity.last_acceleration)
        material, thickness = self.scene.material, self.scene.sheet.thickness
        return f"""<mujoco>
          <option timestep="{settings["time_step"]}" gravity="{_words(gravity)}" integrator="discrete">
            <flag contact="disable"/></option>
          <worldbody><flexcomp name="sheet" type="grid" dim="2" count="{count[0]} {count[1]} 1"
              spacing="{lx} {ly} {lx}" pos="{centre[0]} {centre[1]} 0" mass="1"
              radius="{min(thickness, *self.spacing.tolist()) / 4}">
            <elasticity young="{material.young}" poisson="{material.poisson}" thickness="{thickness}"
              elastic2d="{settings["elastic2d"]}"/>
            <contact selfcollide="none"/>
            <pin id="{_words(np.flatnonzero(pinned.ravel()))}"/>
          </flexcomp></worldbody></mujoco>"""

    def _row(self, edge: str, i: np.ndarray, j: np.ndarray) -> np.ndarray:
        """Return how far vertices lie outside an edge, in rows: 0 on it."""
        along = (i, j)[EDGES[edge].normal_axis]
        last = (self.nx, self.ny)[EDGES[edge].normal_axis] - 1
        row: np.ndarray = along - last if EDGES[edge].far_end else -along
        return row

    def _indices(self, rest: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        i, j = np.rint(rest[:, :2] / self.spacing).astype(int).T
        return i, j

    def number(self, rest: np.ndarray) -> np.ndarray:
        """Return the number j nx + i of vertices at rest (n, 3) [m]; −1 beyond the sheet."""
        i, j = self._indices(rest)
        inside = (i >= 0) & (i < self.nx) & (j >= 0) & (j < self.ny)
        return np.where(inside, j * self.nx + i, -1)

    def masses(self, rest: np.ndarray) -> np.ndarray:
        """Return tributary masses with payloads (n,) [kg]."""
        i, j = self._indices(rest)
        share = np.where((i == 0) | (i == self.nx - 1), 0.5, 1.0) * np.where(
            (j == 0) | (j == self.ny - 1), 0.5, 1
        )
        per_cell = self.scene.material.density * self.scene.sheet.thickness * float(np.prod(self.spacing))
        masses: np.ndarray = per_cell * share
        for payload in self.scene.masses:
            masses = masses + payload.mass * self._shares(rest, payload.at)
        return masses

    def forces(self, rest: np.ndarray) -> np.ndarray:
        """Return point loads (n, 3) [N], shared bilinearly."""
        force = np.zeros_like(rest)
        for load in self.scene.loads:
            if isinstance(load, PointLoad):
                force += load.last_factor * self._shares(rest, load.at)[:, None] * np.array(load.force)
        return force

    def _shares(self, rest: np.ndarray, at: PlanPoint | None) -> np.ndarray:
        """Return the bilinear shares (n,) of the vertices at a plan point [m]."""
        away = np.abs(rest[:, :2] - np.array(at)) / self.spacing
        return np.asarray(np.prod(np.clip(1.0 - away, 0.0, None), axis=1))


def relax(mujoco: Any, model: Any, data: Any, tolerance: float) -> tuple[int, bool]:
    """Step until one more step would move nothing by more than the tolerance [m].

    Velocities are set to zero whenever the kinetic energy has passed a peak. Returns the number of steps, and
    whether the sheet came to rest within `STEPS` of them.
    """
    before, step = 0.0, model.opt.timestep
    for count in range(1, STEPS + 1):
        mujoco.mj_step(model, data)
        energy = float(data.qvel @ data.qvel)
        if not np.isfinite(energy):
            return count, False
        if energy < before:
            data.qvel[:] = 0.0
            energy = 0.0
        before = energy
        move = step**2 * np.abs(data.qacc).max() + step * np.abs(data.qvel).max()
        if count > FIRST_STEPS and move < tolerance:
            return count, True
    return STEPS, False


def _refusal(scene: Scene) -> str:
    if scene.drawn_by:
        return f"{scene.drawn_by}: it supports isotropic whole rectangles that are the same all over"
    if any(not isinstance(s, Clamped | Hinged) for s in scene.supports) or scene.actuators:
        return "MuJoCo's sheet is held by clamped and hinged edges only"
    if any(s.motion is not None or (isinstance(s, Clamped) and s.tilt) for s in scene.supports):
        return "clamps of MuJoCo's sheet cannot be tilted, nor its supports move"
    if scene.obstacles:
        return "obstacles are not passed to it"
    if any(not isinstance(load, PointLoad) for load in scene.loads):
        return "gravity and point loads only"
    return ""


def _shape(scene: Scene, grid: Any) -> tuple[int, int]:
    if isinstance(grid, int) and grid >= 3:
        along_x, along_y = near_square(scene.sheet, grid - 1)
        return along_x + 1, along_y + 1
    if isinstance(grid, list | tuple) and len(grid) == 2 and min(grid) >= 3:
        return int(grid[0]), int(grid[1])
    raise BadInput(f"grid = {grid!r}: vertices along the shorter side, or [nx, ny]; 3 at least")


def _words(values: Any) -> str:
    return " ".join(str(value) for value in values)


def _solution(
    scene: Scene,
    settings: Mapping[str, Any],
    shape: tuple[int, int],
    displacement: np.ndarray,
    status: Status,
    message: str,
    unknowns: int,
    steps: int,
    seconds: tuple[float, float],
) -> Solution:
    """Return the answer of displacements (ny, nx, 3) [m] on the grid."""
    nx, ny = shape
    x, y = (np.linspace(0.0, side, n) for side, n in zip(scene.sheet.lengths, shape, strict=True))
    field = RegularGridInterpolator((y, x), displacement)
    corner = (np.arange(ny - 1)[:, None] * nx + np.arange(nx - 1)).ravel()
    quads = np.column_stack([corner, corner + 1, corner + nx + 1, corner + nx])
    plan = np.column_stack([np.tile(x, ny), np.repeat(y, nx), np.zeros(nx * ny)])
    return Solution(
        model="mujoco",
        label=f"MuJoCo {nx}×{ny} {settings['elastic2d']}",
        settings={**settings, "grid": [nx, ny]},
        status=status,
        unknowns=unknowns,
        iterations=steps,
        setup_seconds=seconds[0],
        solve_seconds=seconds[1],
        sample=lambda points: field(np.clip(points[:, ::-1], 0.0, [y[-1], x[-1]])),
        reactions={},
        energies={},
        mesh=FieldMesh(plan, [("quad", quads)], {"displacement": displacement.reshape(-1, 3)}),
        load_factor=1.0 if status is Status.CONVERGED else 0.0,
        remarks=(message,) if message else (),
    )


MODEL = MuJoCo()
