"""The calibration "auto": `consistent`, `consistent-membrane` or rubber, by the scene.

Of a material with a law of rubber they are of that law, `hyperelastic`. Of the others, a load that would
stretch a strip that it hangs from by more than STRETCHED has them `neo-hookean`: links that are linear in
their elongation mean no material there. Below that their linear bending is the same to the last digit. Where
a sheet bends far, cells that are too stiff in their own plane make `consistent` err, stiff; where edges hold
a sheet whose deflection is a few thicknesses that hides chords taken for arcs, which err the other way and
are all that `consistent-membrane` has left. Before anything is solved the second is chosen

- where one edge alone holds the sheet: nothing makes it stretch as a whole;
- of two adjacent edges where the load is large for the thickness, (q a³/D)(a/h) above FAR, q the load along
  the normal and q a⁴/D h the deflection in thicknesses but for a factor;
- for ν above INCOMPRESSIBLE, whatever holds the sheet: there the links on a cell's sides are least too stiff,
  and what else errs, stiff, is more than chords for arcs;

and `consistent` elsewhere. FAR and INCOMPRESSIBLE were set on scenes, the transfer study's and 97 drawn as
the advisor's are (docs/theory.md, section 3, with what they do on others).
"""

from __future__ import annotations

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
    """Return the calibration requested, None where nothing is; and where it is "auto", or nothing but the
    grading "auto" is requested, the one for this scene, and why."""
    left_open = lattice.calibration is lattice.k is lattice.layer_distance is None
    if scene.material.law is not None and lattice.k is None and lattice.calibration in (None, AUTO):
        return RUBBER, f"the material has the law {scene.material.law}"
    if scene.material.law is not None and lattice.calibration not in OF_A_LAW:
        left_out = f"the material's law {scene.material.law}, which {RUBBER} has, is left out"
        return lattice.calibration, f"linear springs: {left_out}, at a stretch of ε about ε of the force"
    if lattice.calibration != AUTO and not (left_open and lattice.grading == AUTO):
        return lattice.calibration, ""
    if grid[2] != LAYERS and not scales(scene).strain > STRETCHED:
        return CALIBRATION, f"the usual one, of {grid[2]} layers"
    return method_for(scene)


def method_for(scene: Scene) -> tuple[str, str]:
    """Return the name of a calibration, and why in a sentence."""
    if (strain := scales(scene).strain) > STRETCHED:
        return "neo-hookean", f"q a/(E h) = {strain:.2g} is above {STRETCHED:g}: it stretches as rubber may"
    held = {support.edge for support in scene.supports}
    known = all(isinstance(s, Clamped | Hinged | Curved) and s.motion is None for s in scene.supports)
    if scene.actuators or not held or not known or scene.shaped_by:
        return CALIBRATION, "the usual one, for edges that are not simply clamped, hinged or bent"
    if scene.material.poisson > INCOMPRESSIBLE:
        return MEMBRANE, f"ν = {scene.material.poisson:g} is above {INCOMPRESSIBLE:g}"
    if len(held) == 1:
        return MEMBRANE, f"{next(iter(held))} alone holds the sheet"
    if len(held) == 2 and len({EDGES[edge].normal_axis for edge in held}) == 2:
        numbers = scales(scene)
        far = numbers.bending_number / numbers.slenderness
        one, other = sorted(held)
        beside = f"{'above' if far > FAR else 'not above'} {FAR:g}"
        reason = f"{one} and {other} hold the sheet, (q a³/D)(a/h) = {far:.3g} is {beside}"
        return MEMBRANE if far > FAR else CALIBRATION, reason
    return CALIBRATION, "edges hold the sheet on several sides, so that it stretches as it bends"
