"""Keys of a scene that people ask for and that sheetbench does not have, with what it has instead.

They are refused with that sentence and the page of limits, not as slips of typing. Whoever adds one of them
takes its line away.
"""

from __future__ import annotations

PAGE = "docs/limits.md"

_LAYERS = "a laminate is [[layer]]s, from the lower face up, each with its thickness and angle"
_HOLE = "a hole, a slit or a notch is a [[cutout]] with a shape"
_UNIFORM = "a part with a thickness or a material of its own is a [[patch]], not magnetic"
_OUTLINE = "a sheet that is no rectangle has an `outline` in [sheet], the corners of a polygon"
_FIBRES = (
    "fibres are [material] kind = 'orthotropic' with young_1, young_2, poisson_12, shear_12 and an angle; no "
    "other anisotropy is modelled"
)
_RUBBER = (
    "of rubber there are the laws neo-hookean, mooney-rivlin, yeoh and gent: `law` in [material], each with "
    "its own constants"
)
_VISCOUS = (
    "viscosity is linear and of the whole [material]: damping_time, damping_rate, loss_factor with a "
    "frequency or a band, or [[material.relaxation]]"
)
_CONTACT = (
    "what the sheet touches is an [[obstacle]], a rigid plane, sphere or cylinder, with friction in "
    "motion; no other bodies, nor the sheet itself"
)
_STRESS_FREE = "what the sheet is stretched by where it is drawn is [natural] strain or pretension"
_FLAT = "a sheet that is bent where nothing acts on it has a [natural] curvature"
_FROM_REST = (
    'motion starts at rest, from the flat sheet or, with [initial] shape = "static", from the equilibrium '
    "under loads, of which those with hold = true are let go at t = 0; `history` makes loads come and go"
)
_HEAT = "heat is [temperature] with an expansion of the material; swelling and growth are [natural] strain"
_FLUID = "of a fluid there is the drag of still air, [air]; no flow, lift or mass that moves along"
_FIELDS = "magnetic and electric forces are not modelled; give the loads that they make"
_ACTUATORS = "actuators are chains of segments on an edge and prescribed motions of an edge"
_RIGID = "supports are rigid: elastic ones are not modelled"
_PLASTIC = "plasticity, damage and fracture are not modelled"

_WORDS = {
    _LAYERS: "layers laminate laminates ply plies lamina",
    _HOLE: "hole holes cutouts cut cuts slit slits notch notches",
    _UNIFORM: "patches region regions inclusion inclusions stiffener stiffeners magnet magnets",
    _OUTLINE: "contour diameter",
    _FIBRES: "young_x young_y young_z poisson_xy poisson_yx poisson_21 shear_xy orthotropic orthotropy "
    "anisotropic fibre fibres fiber fibers fibre_angle fiber_angle",
    _RUBBER: "laws hyperelastic neo_hookean ogden yeoh gent c10 c01 c20 c30",
    _VISCOUS: "prony viscoelastic viscoelasticity viscosity creep tan_delta damping_ratio quality",
    _CONTACT: "contact contacts obstacles floor ground table wall ball rod box self_contact",
    _STRESS_FREE: "prestretch pre_stretch prestrain pre_strain prestress pre_stress "
    "residual_stress initial_stress initial_strain",
    _FLAT: "rest_shape rest_curvature natural_curvature initial_curvature",
    _FROM_REST: "initial_state initial_displacement initial_velocity velocity release",
    _HEAT: "heat thermal thermal_expansion swelling growth",
    _FLUID: "fluid water wind lift added_mass buoyancy aerodynamics",
    _FIELDS: "magnetic magnetisation magnetization electric voltage charge",
    _ACTUATORS: "tendon tendons cable cables muscle muscles bellows chamber pneumatic",
    _RIGID: "foundation elastic spring",
    _PLASTIC: "plasticity plastic yield yield_stress damage fracture",
}
WISHES = {word: sentence for sentence, words in _WORDS.items() for word in words.split()}


def wish(word: str) -> str | None:
    """The sentence about a key or a kind that is not modelled, with the page; None for any other."""
    sentence = WISHES.get(word.lower().replace("-", "_"))
    return f"{sentence} ({PAGE})" if sentence else None
