"""Construction of a scene's lattice under its supports and loads."""

from __future__ import annotations

from functools import partial

from lumped.actuators import Coupling
from lumped.assembly import Assembly
from lumped.calibration import Calibration
from lumped.contact import Contact
from lumped.lattice import Weights
from lumped.loads import Loads
from lumped.pretension import stretched
from lumped.sections import require_alike
from lumped.statics.problem import Problem
from lumped.supports import constrain
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.natural_state import natural_of_cells
from sheetbench.scenes.objects.orthotropy import FIBRES


def build_problem(
    scene: Scene,
    calibration: Calibration,
    weights: Weights = "tributary",
    previous: Problem | None = None,
) -> Problem:
    """Return the lattice of a scene under its supports and loads.

    Parameters
    ----------
    scene : Scene
        Sheet, material, supports, loads, actuators and obstacles.
    calibration : Calibration
        Springs of the lattice.
    weights : {"tributary", "full"}, default "tributary"
        Shares of boundary links and masses: by tributary area, or full ones (Habibi et al.).
    previous : Problem, optional
        Problem of this scene with other springs, whose supports and loads are reused on an equal lattice.

    Returns
    -------
    Problem
        Residual, tangent and factors of the lattice at displacements (n, 3) [m] and load factors.

    Raises
    ------
    BadInput
        If no mass is free to move.
    Impossible
        If the springs are of equal cells and the scene's cells differ.
    """
    fibres_alone = calibration.of_material and scene.varied_by == FIBRES and not scene.shaped_by
    if (calibration.cells is None or calibration.of_material) and not fibres_alone:
        instead = "calibrate with cells=lumped.sections_of(scene, grid)"
        require_alike(scene, f"the calibration {calibration.method}", instead)
    couple = partial(Coupling, scene) if scene.actuators else None
    assembly = Assembly(scene.sheet, calibration, weights, couple, scene.twisting_edges())
    lines = assembly.lattice.lines
    if (state := natural_of_cells(stretched(scene, assembly), *(line.at for line in lines))) is not None:
        assembly.grow(state)
    on_lattice = previous is not None and previous.assembly.lattice is assembly.lattice
    if previous is not None and on_lattice and couple is None and assembly.natural is None:
        return Problem(scene, assembly, previous.constraints, previous.loads, previous.items)
    constraints = constrain(scene, assembly.lattice, assembly.coupling)
    if not constraints.transform.shape[1]:
        grid = "×".join(str(n) for n in assembly.lattice.grid)
        raise BadInput(f"grid = {grid}: the supports hold every mass; take a finer one")
    items = tuple(Contact(scene, assembly, *obstacle) for obstacle in scene.named_obstacles().items())
    return Problem(scene, assembly, constraints, Loads(scene, assembly), items)
