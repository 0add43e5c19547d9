"""Keys that are often written into a scene but name no feature of sheetbench, and a sentence for each.

The refusal of a scene shows the sentence, which names the nearest feature, and the page of limits instead of
a guess at a slip of typing. A feature that is added takes its line away here.
"""

PAGE = "docs/limits.md"

INSTEAD = {  # by the words that are often written: the feature of sheetbench
    "layers laminate laminates ply plies lamina": "a laminate is [[layer]]s, from the lower face up, each "
    "with its thickness and angle",
    "hole holes cutouts cut cuts slit slits notch notches": "a hole, a slit or a notch is a [[cutout]] with "
    "a shape",
    "patches region regions inclusion inclusions stiffener stiffeners magnet magnets": "a part with a "
    "thickness or a material of its own is a [[patch]], not magnetic",
    "contour diameter": "a sheet that is no rectangle has an `outline` in [sheet], the corners of a polygon",
    "young_x young_y young_z poisson_xy poisson_yx poisson_21 shear_xy orthotropic orthotropy anisotropic "
    "fibre fibres fiber fibers fibre_angle fiber_angle": "fibres are [material] kind = 'orthotropic' with "
    "young_1, young_2, poisson_12, shear_12 and an angle; no other anisotropy is modelled",
    "laws hyperelastic neo_hookean ogden yeoh gent c10 c01 c20 c30": "laws of rubber are "
    "neo-hookean, mooney-rivlin, yeoh and gent: `law` in [material], each with its own constants",
    "prony viscoelastic viscoelasticity viscosity creep tan_delta damping_ratio quality": "viscosity is "
    "linear and of the whole [material]: damping_time, damping_rate, loss_factor with a frequency or a "
    "band, or [[material.relaxation]]",
    "contact contacts obstacles floor ground table wall ball rod box self_contact": "a body that the "
    "sheet touches is an [[obstacle]]: a rigid plane, sphere, cylinder or box, with friction in motion; the "
    "sheet does not touch itself",
    "prestretch pre_stretch prestrain pre_strain prestress pre_stress residual_stress initial_stress "
    "initial_strain": "the stretch of the sheet as it is drawn is [natural] strain or pretension",
    "rest_shape rest_curvature natural_curvature initial_curvature": "a sheet that is bent without "
    "loads has a [natural] curvature",
    "initial_state initial_displacement initial_velocity velocity release": "motion starts at rest, from "
    'the flat sheet or, with [initial] shape = "static", from the equilibrium under loads, of which those '
    "with hold = true are let go at t = 0; `history` makes loads come and go",
    "heat thermal thermal_expansion swelling growth": "heat is [temperature] with an expansion of the "
    "material; swelling and growth are [natural] strain",
    "fluid water wind lift added_mass buoyancy aerodynamics": "the only fluid force is the drag of still "
    "air, [air]; no flow, lift or added mass",
    "magnetic magnetisation magnetization electric voltage charge": "magnetic and electric forces are not "
    "modelled; give the loads that they make",
    "tendon tendons cable cables muscle muscles bellows chamber pneumatic": "actuators are chains of "
    "segments on an edge and prescribed motions of an edge",
    "foundation elastic spring": "supports are rigid: elastic ones are not modelled",
    "plasticity plastic yield yield_stress damage fracture": "plasticity, damage and fracture are not "
    "modelled",
}
UNSUPPORTED = {word: sentence for words, sentence in INSTEAD.items() for word in words.split()}


def unsupported_note(word: str) -> str | None:
    """Return the sentence about a key or a kind that is not modelled, with the page, else None."""
    sentence = UNSUPPORTED.get(word.lower().replace("-", "_"))
    return f"{sentence} ({PAGE})" if sentence else None
