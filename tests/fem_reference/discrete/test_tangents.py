"""The tangent of every discrete sheet is the derivative of its forces, at a random shape."""

import numpy as np
import pytest
from rod_cases import SHEET, chain, driven

from fem_reference.discrete.static import Static, StaticState
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.solid.materials import LAWS
from fem_reference.surface.mesh import rectangle
from sheetbench.choices import STRAIN_LAWS
from sheetbench.scenes import Curved, Hinged, Material, Scene, Sheet

LOADED = {
    "gravity": {"acceleration": [0.0, 1.0, -9.81]},
    "supports": [
        {"edge": "x0", "kind": "curved", "curvature": 0.8},
        {"edge": "x1", "kind": "held", "components": ["x"]},
    ],
    "loads": [
        {"kind": "pressure", "value": 40.0},
        {"kind": "edge", "edge": "y1", "force_per_length": (1.0, 2.0, 3.0), "moment_per_length": 2.0},
        {"kind": "point", "at": (0.4, 0.3), "force": (1.0, -1.0, 0.5)},
    ],
}
CHAINS = driven(chain(face="top", curvature=3.0, plane="spatial"), chain(edge="y0", base="start"))


def loaded(law):
    """Pressure, edge moment, weight and a bent rod."""
    own = {"young": 1e4, "poisson": 0.4, "density": 10.0}
    own |= {"law": law} if law not in ("st-venant-kirchhoff", "biot") else {}
    sheet = Sheet(length_x=1.0, length_y=0.8, thickness=0.1)
    return Scene(name="all", sheet=sheet, material=Material(**own), **LOADED)


def chained():
    """Rods on two edges that share a corner, beside a hinged and a curved edge."""
    supports = (Curved(edge="x0", curvature=0.8), Hinged(edge="y1"))
    return CHAINS.model_copy(update={"supports": supports})


def sheets():
    for law in STRAIN_LAWS:
        mesh = rectangle(loaded(law).sheet, (2, 2), graded=True)
        yield f"shell, {law}", lambda mesh=mesh, law=law: DiscreteShell(mesh, loaded(law), law=law)
        for layers in (1, 2) if law in LAWS else ():
            name = f"solid, {law}, {layers}"
            yield name, lambda mesh=mesh, law=law, n=layers: DiscreteSolid(mesh, loaded(law), n, law)
    mesh = rectangle(SHEET, 2)
    yield "shell, chains", lambda: DiscreteShell(mesh, chained())
    yield "shell, free chains", lambda: DiscreteShell(mesh, CHAINS.model_copy(update={"supports": ()}))
    for layers in (1, 2):
        yield f"solid, chains, {layers}", lambda n=layers: DiscreteSolid(mesh, chained(), n)


SHEETS = dict(sheets())


@pytest.mark.parametrize("name", SHEETS)
def test_the_tangent_is_the_derivative_of_the_force(name):
    """Along what is free, directors on their spheres: forces at a step's ends are those on tangent planes."""
    sheet, rng, at = SHEETS[name](), np.random.default_rng(1), 0.7
    static, flat = Static(sheet), sheet.on_supports(np.zeros(sheet.size), at)
    move = sheet.expand(sheet.shape(flat, at), rng.normal(size=sheet.unknowns))
    q = sheet.moved(flat, np.where(sheet.scale == 1.0, 2e-3 * sheet.longer_side, 2e-2) * move)
    forces = static.forces(StaticState(q), at)
    matrix, _ = static.linearised(StaticState(q), forces, at, mixed=False)
    step = rng.normal(size=sheet.unknowns)
    along = sheet.expand(forces.shape, step)

    def rows(t):
        ahead = sheet.moved(q, t * along)
        residual = static.forces(StaticState(ahead), at).residual
        if sheet.model == "shell":
            on_directors, directors = residual[3 * sheet.nodes :].reshape(-1, 3), sheet.directors(ahead)
            on_directors -= np.einsum("nc,nc->n", on_directors, directors)[:, None] * directors
        return sheet.reduce(forces.shape, residual)

    difference = (rows(1e-6) - rows(-1e-6)) / 2e-6
    np.testing.assert_allclose(matrix @ step, difference, atol=2e-6 * np.abs(difference).max())
    if not sheet.scene.loads:
        assert abs(matrix - matrix.T).max() < 1e-9 * abs(matrix).max()
