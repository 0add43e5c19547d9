"""Construction of a scene's lattice under its supports and loads."""

from functools import partial

from lumped.actuators import Coupling
from lumped.assembly import Assembly
from lumped.calibration import Calibration
from lumped.contact import Contact
from lumped.lattice import Weights
from lumped.loads import Loads
from lumped.pretension import with_pretension_strain
from lumped.sections import require_alike
from lumped.statics.problem import Problem
from lumped.supports import constrain
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.natural_state import natural_of_cells
from sheetbench.scenes.objects.orthotropy import FIBRES

OF_SPRINGS = ("sheet", "material", "patches", "layers", "natural", "temperature", "actuators")
OF_PARTS = (*OF_SPRINGS, "supports")


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
        Problem of a scene with an equal plan, grid and twisting edges, whose equal parts are taken over.

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
    alike = {
        key
        for key in OF_PARTS
        if previous is not None and getattr(scene, key) == getattr(previous.scene, key)
    }
    if previous is not None and alike >= {*OF_SPRINGS} and previous.assembly.calibration is calibration:
        assembly = previous.assembly
    else:
        couple = partial(Coupling, scene) if scene.actuators else None
        plan = None if previous is None else previous.assembly.lattice
        assembly = Assembly(scene.sheet, calibration, weights, couple, scene.twisting_edges(), plan)
        x, y = (line.at for line in assembly.lattice.lines)
        if (state := natural_of_cells(with_pretension_strain(scene, assembly), x, y)) is not None:
            assembly.grow(state)
    if previous is not None and "supports" in alike and assembly.coupling is previous.assembly.coupling:
        constraints = previous.constraints.on(assembly.lattice)
    else:
        constraints = constrain(scene, assembly.lattice, assembly.coupling)
    if not constraints.transform.shape[1]:
        grid = "×".join(str(n) for n in assembly.lattice.grid)
        raise BadInput(f"grid = {grid}: the supports hold every mass; take a finer one")
    items = tuple(Contact(scene, assembly, *obstacle) for obstacle in scene.named_obstacles().items())
    return Problem(scene, assembly, constraints, Loads(scene, assembly), items)
