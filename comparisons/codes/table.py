"""Parameters of other people's codes from a cell's coefficients, in each code's own words and units.

Each code with its elements, the formula of each parameter, the line of its source that defines it, the limits
of its sheet and the mesh to take. Only laws at small strain count. C(λh, μh, hinge) are our coefficients
[N/m, N/m, by the hinge's weight], h the thickness [m], ρ the density [kg/m³].
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

Numbers = Mapping[str, float]
BEND_SCALE = 1.28e-5  # ppf-contact-solver's own number


@dataclass(frozen=True)
class Key:
    """A parameter: its unit and convention there, and its value from coefficients, h and ρ."""

    name: str
    unit: str
    convention: str
    value: Callable[[Numbers], float]


@dataclass(frozen=True)
class Code:
    """A code. hinge: the weight of its hinges; dampers: its form of a material's one damper, none for a code
    without damping in proportion to the stiffness; elements: "triangles", or "springs" alone; mesh: the one
    to take. Filled in for codes with files: cannot, the limits of its sheet; source, a repository, a file and
    a quotation; licence."""

    name: str
    title: str
    hinge: str
    keys: tuple[Key, ...]
    dampers: tuple[Key, ...] = ()
    elements: str = "triangles"
    mesh: str = "alternate-diagonals"
    cannot: str = ""
    source: str = ""
    licence: str = ""


def _stretching(c: Numbers) -> float:
    """Return C11 h = E h/(1 − ν²)."""
    return c["lambda_h"] + 2.0 * c["mu_h"]


def _poisson(c: Numbers) -> float:
    return c["lambda_h"] / _stretching(c)


def _young_h(c: Numbers) -> float:
    return 2.0 * c["mu_h"] * (1.0 + _poisson(c))


def _young(c: Numbers) -> float:
    return _young_h(c) / c["thickness"]


def _spatial_poisson(c: Numbers) -> float:
    """Return the Poisson's ratio ν/(1 + ν) for which a solid's λ/μ equals the plane-stress λ/μ of the
    sheet."""
    return c["lambda_h"] / (2.0 * (c["lambda_h"] + c["mu_h"]))


def _rigidity(c: Numbers) -> float:
    return _stretching(c) * c["thickness"] ** 2 / 12.0


def _areal(c: Numbers) -> float:
    return c["density"] * c["thickness"]


def _flex_thickness(c: Numbers) -> float:
    return float((36.0 * c["hinge"] / _stretching(c)) ** 0.5)


def _of(name: str, factor: float = 1.0) -> Callable[[Numbers], float]:
    return lambda c: factor * c[name]


def _one_over(name: str) -> Callable[[Numbers], float]:
    return lambda c: 1.0 / c[name]


OWN, PER_AREA = "the sheet's own", "of the area: times thickness"
DENSITY = Key("density", "kg/m³", "of the volume", _of("density"))
AREAL = Key("density", "kg/m²", PER_AREA, _areal)
HINGED = "hinges bend as an isotropic sheet of ν = −1/3 (equilateral cells) or of no ν: see docs/cells.md"


def _damper(name: str) -> Key:
    return Key(name, "s", "times the stiffness, of membrane and hinges", _of("damping_time"))


NEWTON = Code(
    "newton",
    "Newton 1.8, VBD",
    "length",
    (
        Key("tri_ke", "N/m", "μ of the membrane: per area, times thickness", _of("mu_h")),
        Key("tri_ka", "N/m", "λ of the membrane: per area, times thickness", _of("lambda_h")),
        Key("edge_ke", "N", "½ edge_ke L θ² of an edge: times its length", _of("hinge")),
    ),
    cannot=HINGED,
    source="newton-physics/newton 1.8.0, newton/_src/solvers/vbd/particle_vbd_kernels.py: evaluate_neo_"
    "hookean_membrane_force_hessian («lambda_NH = lambda_Lamé + mu_Lamé», so tri_ka is Lamé's), "
    "evaluate_dihedral_angle_based_bending_force_hessian («k = stiffness * edge_rest_length»); "
    "hinges of triangles below 5e-7 m² are left out there (n1_norm < eps)",
    licence="Apache-2.0",
)
MUJOCO = Code(
    "mujoco",
    "MuJoCo 4.0, flex",
    "height",
    (
        Key(
            "young",
            "Pa",
            "membrane E h over the thickness below, not the sheet's E",
            lambda c: _young_h(c) / _flex_thickness(c),
        ),
        Key("poisson", "", OWN, _poisson),
        Key("thickness", "m", "sets the hinges' stiffness, not the sheet's", _flex_thickness),
    ),
    (_damper("damping"),),
    cannot=HINGED + "; its bending energy is quadratic in the positions",
    source="forces of the wheel 4.0.0, measured (tests/comparisons/codes/test_simulators.py): E, ν and "
    "thickness make plane stress, and hinges ½ D L²/(A₁ + A₂) θ². Before, google-deepmind/mujoco at "
    "a725507, src/user/user_mesh.cc: λ of a solid (ComputeStiffness), «3 * mu * pow(thickness, 3) / "
    "(24 * volume)» in place of D/(A₁ + A₂) (ComputeBending)",
    licence="Apache-2.0",
)
PYBULLET = Code(
    "pybullet",
    "PyBullet 3.2.7, mass-spring soft body",
    "",
    (
        Key("springElasticStiffness", "N/m", "of every link, whatever its length", _of("k")),
        Key("layers", "m", "distance of the two layers of nodes", _of("layers")),
    ),
    (
        Key(
            "springDampingStiffness",
            "N·s/m",
            "of every link, along it; the script has more, to come to rest",
            lambda c: c["damping_time"] * c["k"],
        ),
    ),
    "springs",
    "tetrahedra",
    "a cloth of one layer has no bending stiffness while it is flat, whatever springBendingStiffness "
    "is: take two layers of nodes in tetrahedra; one k for all links gives about ν = 1/3, and for "
    "another ν only one of the sheet's stiffnesses is matched",
    "bulletphysics/bullet3, src/BulletSoftBody/btDeformableMassSpringForce.h: addScaledElasticForce "
    "(«scaled_stiffness * (dir - dir_normalized * r)»); springBendingStiffness is of links between "
    "nodes two links apart (btSoftBody.cpp, generateBendingConstraints)",
    "zlib",
)
GENESIS = Code(
    "genesis",
    "Genesis 1.4, PBD cloth",
    "angle",
    (
        Key(
            "stretch_compliance",
            "m/N",
            "1/k of every side of a triangle at rest; the engine is given 1/k − (1/m₁ + 1/m₂) dt²",
            _one_over("k"),
        ),
        Key(
            "bending_compliance",
            "rad/(N·m)",
            "1/k, ½ k θ² of an edge; the engine is given each hinge's bending_relaxation = k W dt²",
            _one_over("hinge"),
        ),
        Key("rho", "kg/m²", PER_AREA, _areal),
    ),
    elements="springs",
    cannot="springs along triangles' sides give about ν = 1/3; hinges with a bending compliance above 0 "
    "do not resist the bending of a flat sheet, and one bending_relaxation for all makes those near "
    "clamps too stiff; the engine remeshes the given mesh unless the script prevents it",
    source="Genesis-Embodied-AI/Genesis 1.4.5, genesis/engine/solvers/pbd_solver.py: _kernel_solve_stretch "
    "(«dp = -C / (w1 + w2 + alpha)», «alpha = … compliance / substep_dt**2», no multiplier is kept), "
    "_kernel_solve_bending («-sqrt(1 - d**2) * constraint / (sum_wq + alpha)» where both have a sine "
    "to be divided by); materials/PBD/cloth.py («rho … is kg/m²»); pbd_entity.py («remesh("
    "edge_len_abs=particle_size)»)",
    licence="Apache-2.0",
)
# sofa-framework/sofa, …/fem/elastic/TriangularFEMForceField.inl: computeMaterialStiffness («materialMatrix *=
# (y / (1.0f - p * p)) * tinfo->area»: no thickness); …/spring/FastTriangularBendingSprings.inl: setEdgeSpring
# («lambda = (2./3) * (ha+hb)/(ha*ha*hb*hb) * l * materialBendingStiffness»)
SOFA = Code(
    "sofa",
    "SOFA 24.06, TriangularFEMForceField and FastTriangularBendingSprings",
    "height",
    (
        Key("youngModulus", "N/m", "E of plane stress, per area: times thickness", _young_h),
        Key("poissonRatio", "", OWN, _poisson),
        Key("bendingStiffness", "N·m", "½ (1/3) k L²/(A₁ + A₂) θ² of an edge", _of("hinge", 9.0)),
    ),
    (_damper("rayleighStiffness"), Key("rayleighMass", "1/s", "times the mass", _of("damping_rate"))),
)
# ArcSim as in DrapeTester/ClothDrapeTester, arcsim/AdaptiveCloth/physics.cpp: bending_energy («shape =
# sq(edge->l) / (2 * a); return ke * shape * sq(theta - …) / 4»), stretching_force («2 * k[3] * G(0, 1)»);
# dde.cpp: evaluate_stretching_sample («real_elastic[0] *= 2»), add_internal_forces («A = dt^2 J + dt damp
# J»). Remeshing changes the hinges' weights.
ARCSIM = Code(
    "arcsim",
    "ArcSim 0.2",
    "height",
    (
        AREAL,
        Key("stretching 1", "N/m", "C11 h/2: the program doubles it", lambda c: _stretching(c) / 2.0),
        Key("stretching 2", "N/m", "C12 h/2", _of("lambda_h", 0.5)),
        Key("stretching 3", "N/m", "C22 h/2", lambda c: _stretching(c) / 2.0),
        Key("stretching 4", "N/m", "G h in the force; the printed energy has half of it", _of("mu_h")),
        Key("bending", "N·m", "⅛ k L²/(A₁ + A₂) θ² of an edge", _of("hinge", 12.0)),
    ),
    (_damper("damping"),),
)
# ipc-sim/Codim-IPC, Library/FEM/Shell/DISCRETE_SHELL.h («lambda = E * nu / (1 - nu * nu)», «k = E *
# std::pow(thickness, 3) / (24 * (1 - nu * nu))», h̄ = (|n1| + |n2|)/(6 |e|)); BENDING.h («k * (theta -
# thetabar) * (theta - thetabar) * ebarnorm / hbar»)
C_IPC = Code(
    "c-ipc",
    "Codim-IPC",
    "height",
    (
        Key("E", "Pa", "the sheet's own: membrane times thickness, plane stress", _young),
        Key("nu", "", OWN, _poisson),
        Key("thickness", "m", "the sheet's own; also the offset of contacts", _of("thickness")),
        DENSITY,
        Key(
            "bendingStiffMult",
            "",
            "times E h³/24(1 − ν²) of θ² L/h̄, h̄ = (A₁ + A₂)/3L",
            lambda c: c["hinge"] / _rigidity(c),
        ),
    ),
)
# st-tech/ppf-contact-solver, crates/ppf-cts-solver/src/cpp/energy/energy.cu: embed_hinge_force_hessian
# («BEND_SCALE * bend_dir * (length * length / area) * areal_density»), embed_face_force_hessian («mass * …»);
# builder.rs: convert_prop (λ of a solid); crates/ppf-cts-core/src/datamodel/params.rs («pre-normalized by
# density (units of Pa/rho)», density in kg/m²)
PPF = Code(
    "ppf",
    "ppf-contact-solver, model arap",
    "height",
    (
        AREAL,
        Key(
            "young-mod",
            "m²/s²",
            "E′/ρ, with λ of a solid: 2 μ h (1 + poiss-rat) over the density per area",
            lambda c: 2.0 * c["mu_h"] * (1.0 + _spatial_poisson(c)) / _areal(c),
        ),
        Key("poiss-rat", "", "of a solid, not of plane stress: ν/(1 + ν)", _spatial_poisson),
        Key(
            "bend",
            "m⁴/s²",
            "½ 1.28e-5 bend ρ_A L²/(A₁ + A₂) θ², called dimensionless there",
            lambda c: 3.0 * c["hinge"] / (BEND_SCALE * _areal(c)),
        ),
    ),
)
# newton-physics/newton 1.8.0, newton/_src/utils/import_usd_deformable_cloth.py: _resolve_surface_structural_
# stiffnesses («youngs * thickness / plane_stress», «youngs * thickness**3 / (12.0 * plane_stress)»). The
# bending stiffness is the sheet's, to be converted to hinges by programs; Newton 1.8 reads it as edge_ke [N],
# which it multiplies by the edge's length, and sets tri_ka = 0: for Newton use the values of --for newton.
OPENUSD = Code(
    "openusd",
    "OpenUSD, deformables proposal as Newton 1.8 reads it",
    "length",
    (
        DENSITY,
        Key("thickness", "m", "the sheet's own: physics:thicknesses of the mesh", _of("thickness")),
        Key("physics:youngsModulus", "Pa", OWN, _young),
        Key("physics:poissonsRatio", "", OWN, _poisson),
        Key("physics:surfaceStretchStiffness", "N/m", "E h/(1 − ν²): times thickness", _stretching),
        Key("physics:surfaceShearStiffness", "N/m", "G h: times thickness", _of("mu_h")),
        Key(
            "physics:surfaceBendStiffness",
            "N·m",
            "E h³/12(1 − ν²), of the sheet and not of an edge",
            _rigidity,
        ),
    ),
)
# Grinspun et al., Discrete shells, SCA 2003, equation (1)
DISCRETE_SHELLS = Code(
    "discrete-shells",
    "Discrete shells (Grinspun et al. 2003)",
    "height",
    (Key("k_B", "N·m", "k θ² L/h̄ of an edge, h̄ = (A₁ + A₂)/3L", _of("hinge", 0.5)),),
)
ALL = (NEWTON, MUJOCO, PYBULLET, GENESIS, SOFA, ARCSIM, C_IPC, PPF, OPENUSD, DISCRETE_SHELLS)
CODES = {code.name: code for code in ALL}
