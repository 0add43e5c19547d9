"""The calibration "auto": `consistent`, `consistent-membrane` or a rubber law, chosen by the scene.

Materials with a rubber law get `hyperelastic`. For other materials the choice is `neo-hookean` if the load
would stretch a hanging strip by more than STRETCHED: links linear in their elongation represent no material
there. Below that strain both have equal linear bending to the last digit. `consistent` is too stiff for large
bending, because its cells are too stiff in their plane. A sheet that deflects a few thicknesses between edges
partly hides this error by the error of chords in place of arcs, which is of opposite sign and the only one
left in `consistent-membrane`. `consistent-membrane` is chosen

- if one edge alone holds the sheet: the sheet need not stretch as a whole;
- for two adjacent edges if the load is large for the thickness, (q a³/D)(a/h) above FAR, with q the load
  along the normal; q a⁴/D h is the deflection in thicknesses up to a factor;
- for ν above INCOMPRESSIBLE with any supports: the links on a cell's sides are then least too stiff, and the
  other stiff errors exceed the error of chords in place of arcs;

and `consistent` elsewhere. FAR and INCOMPRESSIBLE were fitted to the transfer study's scenes and 97 scenes
drawn like the advisor's (docs/theory.md, section 3, with results on others).
"""

from collections.abc import Sequence

from comparisons.models.scales import scales
from comparisons.models.spec import Lattice
from sheetbench.choices import AUTO, CALIBRATION
from sheetbench.scenes import EDGES, Clamped, Curved, Hinged, Scene
from sheetbench.scenes.objects.grid import LAYERS

MEMBRANE = "consistent-membrane"
RUBBER = "hyperelastic"
OF_A_LAW = (RUBBER, "neo-hookean")
INCOMPRESSIBLE = 0.4
FAR = 600.0
STRETCHED = 0.1


def resolve_calibration(scene: Scene, grid: Sequence[int], lattice: Lattice) -> tuple[str | None, str]:
    """Return the name of a lattice's calibration and the reason for a choice made here. The name is None if
    none is requested. A choice is made for "auto", and for an open calibration beside the grading "auto"."""
    is_open = lattice.calibration is lattice.k is lattice.layer_distance is None
    if scene.material.law is not None and lattice.k is None and lattice.calibration in (None, AUTO):
        return RUBBER, f"the material has the law {scene.material.law}"
    if scene.material.law is not None and lattice.calibration not in OF_A_LAW:
        omission = f"the material's law {scene.material.law}, which {RUBBER} has, is left out"
        return (
            lattice.calibration,
            f"linear springs: {omission}: an error of about ε at a stretch ε",
        )
    if lattice.calibration != AUTO and not (is_open and lattice.grading == AUTO):
        return lattice.calibration, ""
    if grid[2] != LAYERS and not scales(scene).strain > STRETCHED:
        return CALIBRATION, f"the default, for {grid[2]} layers"
    return method_for(scene)


def method_for(scene: Scene) -> tuple[str, str]:
    """Return the name of a scene's calibration and the reason in a sentence."""
    if (strain := scales(scene).strain) > STRETCHED:
        return "neo-hookean", f"q a/(E h) = {strain:.2g} is above {STRETCHED:g}: it stretches as rubber may"
    held = {support.edge for support in scene.supports}
    at_rest = all(isinstance(s, Clamped | Hinged | Curved) and s.motion is None for s in scene.supports)
    if scene.actuators or not held or not at_rest or scene.shaped_by:
        return CALIBRATION, "the default, for edges that are not simply clamped, hinged or bent"
    if scene.material.poisson > INCOMPRESSIBLE:
        return MEMBRANE, f"ν = {scene.material.poisson:g} is above {INCOMPRESSIBLE:g}"
    if len(held) == 1:
        return MEMBRANE, f"{next(iter(held))} alone holds the sheet"
    if len(held) == 2 and len({EDGES[edge].normal_axis for edge in held}) == 2:
        numbers = scales(scene)
        far = numbers.bending_number / numbers.slenderness
        relation = f"{'above' if far > FAR else 'not above'} {FAR:g}"
        reason = f"{' and '.join(sorted(held))} hold the sheet, (q a³/D)(a/h) = {far:.3g} is {relation}"
        return MEMBRANE if far > FAR else CALIBRATION, reason
    return CALIBRATION, "edges hold the sheet on several sides, so that it stretches as it bends"
