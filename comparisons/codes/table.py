"""Parameters of other people's codes from a cell's coefficients, in each code's own words and units.

A row is a code: its elements, what each parameter is there, the line of its source that says so, what its
sheet cannot be and which mesh to take. Only laws at small strain count. C(λh, μh, hinge) are our coefficients
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
    """A code. hinge: the weight of its hinges; elements: "triangles", or "springs" alone; mesh: the one to
    take; cannot: what its sheet cannot be; source: repository, file and what stands there; dampers: what a
    material's one damper is there, none where the code has nothing in proportion to the stiffness."""

    name: str
    title: str
    hinge: str
    keys: tuple[Key, ...]
    source: str
    cannot: str = ""
    mesh: str = "alternate-diagonals"
    elements: str = "triangles"
    licence: str = ""
    dampers: tuple[Key, ...] = ()


def _spatial_poisson(c: Numbers) -> float:
    """ν whose three-dimensional λ/μ is the sheet's plane-stress one: ν/(1 + ν) of the sheet's."""
    return c["lambda_h"] / (2.0 * (c["lambda_h"] + c["mu_h"]))


def _plane_poisson(c: Numbers) -> float:
    return c["lambda_h"] / (c["lambda_h"] + 2.0 * c["mu_h"])


def _young_h(c: Numbers) -> float:
    return 2.0 * c["mu_h"] * (1.0 + _plane_poisson(c))


def _rigidity(c: Numbers) -> float:
    return (c["lambda_h"] + 2.0 * c["mu_h"]) * c["thickness"] ** 2 / 12.0


def _flex_thickness(c: Numbers) -> float:
    return float((36.0 * c["hinge"] / (c["lambda_h"] + 2.0 * c["mu_h"])) ** 0.5)


def _flex_young(c: Numbers) -> float:
    return _young_h(c) / _flex_thickness(c)


DENSITY = Key("density", "kg/m³", "of the volume", lambda c: c["density"])
AREAL = Key("density", "kg/m²", "of the area: times thickness", lambda c: c["density"] * c["thickness"])
TIMES_STIFFNESS = "times the stiffness, of membrane and hinges"
HINGED = "hinges bend as an isotropic sheet of ν = −1/3 (equilateral cells) or of no ν: see docs/cells.md"

CODES = {
    row.name: row
    for row in (
        Code(
            "newton",
            "Newton 1.8, VBD",
            "length",
            (
                Key("tri_ke", "N/m", "μ of the membrane: per area, times thickness", lambda c: c["mu_h"]),
                Key("tri_ka", "N/m", "λ of the membrane: per area, times thickness", lambda c: c["lambda_h"]),
                Key("edge_ke", "N", "½ edge_ke L θ² of an edge: times its length", lambda c: c["hinge"]),
            ),
            "newton-physics/newton 1.8.0, newton/_src/solvers/vbd/particle_vbd_kernels.py: evaluate_neo_"
            "hookean_membrane_force_hessian («lambda_NH = lambda_Lamé + mu_Lamé», so tri_ka is Lamé's), "
            "evaluate_dihedral_angle_based_bending_force_hessian («k = stiffness * edge_rest_length»); "
            "hinges of triangles below 5e-7 m² are left out there (n1_norm < eps)",
            HINGED,
            licence="Apache-2.0",
        ),
        Code(
            "mujoco",
            "MuJoCo 4.0, flex",
            "height",
            (
                Key("young", "Pa", "membrane E h over the thickness below, not the sheet's E", _flex_young),
                Key("poisson", "", "the sheet's own", _plane_poisson),
                Key("thickness", "m", "sets the hinges' stiffness, not the sheet's", _flex_thickness),
            ),
            "forces of the wheel 4.0.0, measured (tests/comparisons/codes/test_codes.py): E, ν and "
            "thickness make plane stress, and hinges ½ D L²/(A₁ + A₂) θ². Before, google-deepmind/mujoco at "
            "a725507, src/user/user_mesh.cc: λ of a solid (ComputeStiffness), «3 * mu * pow(thickness, 3) / "
            "(24 * volume)» in place of D/(A₁ + A₂) (ComputeBending)",
            HINGED + "; its bending energy is quadratic in the positions",
            licence="Apache-2.0",
            dampers=(Key("damping", "s", TIMES_STIFFNESS, lambda c: c["damping_time"]),),
        ),
        Code(
            "pybullet",
            "PyBullet 3.2.7, mass-spring soft body",
            "",
            (
                Key("springElasticStiffness", "N/m", "of every link, whatever its length", lambda c: c["k"]),
                Key("layers", "m", "distance of the two layers of nodes", lambda c: c["layers"]),
            ),
            "bulletphysics/bullet3, src/BulletSoftBody/btDeformableMassSpringForce.h: addScaledElasticForce "
            "(«scaled_stiffness * (dir - dir_normalized * r)»); springBendingStiffness is of links between "
            "nodes two links apart (btSoftBody.cpp, generateBendingConstraints)",
            "a cloth of one layer has no bending stiffness while it is flat, whatever springBendingStiffness "
            "is: take two layers of nodes in tetrahedra; one k for all links gives about ν = 1/3, and for "
            "another ν only one of the sheet's stiffnesses is matched",
            "tetrahedra",
            "springs",
            "zlib",
            (
                Key(
                    "springDampingStiffness",
                    "N·s/m",
                    "of every link, along it; the script has more, to come to rest",
                    lambda c: c["damping_time"] * c["k"],
                ),
            ),
        ),
        Code(
            "genesis",
            "Genesis 1.4, PBD cloth",
            "angle",
            (
                Key(
                    "stretch_compliance",
                    "m/N",
                    "1/k of every side of a triangle at rest; the engine is given 1/k − (1/m₁ + 1/m₂) dt²",
                    lambda c: 1.0 / c["k"],
                ),
                Key(
                    "bending_compliance",
                    "rad/(N·m)",
                    "1/k, ½ k θ² of an edge; the engine is given each hinge's bending_relaxation = k W dt²",
                    lambda c: 1.0 / c["hinge"],
                ),
                Key("rho", "kg/m²", "of the area: times thickness", lambda c: c["density"] * c["thickness"]),
            ),
            "Genesis-Embodied-AI/Genesis 1.4.5, genesis/engine/solvers/pbd_solver.py: _kernel_solve_stretch "
            "(«dp = -C / (w1 + w2 + alpha)», «alpha = … compliance / substep_dt**2», no multiplier is kept), "
            "_kernel_solve_bending («-sqrt(1 - d**2) * constraint / (sum_wq + alpha)» where both have a sine "
            "to be divided by); materials/PBD/cloth.py («rho … is kg/m²»); pbd_entity.py («remesh("
            "edge_len_abs=particle_size)»)",
            "springs along triangles' sides give about ν = 1/3; hinges with a bending compliance above 0 "
            "do not resist the bending of a flat sheet, and one bending_relaxation for all makes those near "
            "clamps too stiff; the engine remeshes the given mesh unless the script prevents it",
            elements="springs",
            licence="Apache-2.0",
        ),
        Code(
            "sofa",
            "SOFA 24.06, TriangularFEMForceField and FastTriangularBendingSprings",
            "height",
            (
                Key("youngModulus", "N/m", "E of plane stress, per area: times thickness", _young_h),
                Key("poissonRatio", "", "the sheet's own", _plane_poisson),
                Key(
                    "bendingStiffness",
                    "N·m",
                    "½ (1/3) k L²/(A₁ + A₂) θ² of an edge",
                    lambda c: 9.0 * c["hinge"],
                ),
            ),
            "sofa-framework/sofa, …/fem/elastic/TriangularFEMForceField.inl: computeMaterialStiffness («"
            "materialMatrix *= (y / (1.0f - p * p)) * tinfo->area»: no thickness); …/spring/"
            "FastTriangularBendingSprings.inl: setEdgeSpring («lambda = (2./3) * (ha+hb)/(ha*ha*hb*hb) * l * "
            "materialBendingStiffness»)",
            HINGED,
            licence="LGPL-2.1",
            dampers=(
                Key("rayleighStiffness", "s", TIMES_STIFFNESS, lambda c: c["damping_time"]),
                Key("rayleighMass", "1/s", "times the mass", lambda c: c["damping_rate"]),
            ),
        ),
        Code(
            "arcsim",
            "ArcSim 0.2",
            "height",
            (
                AREAL,
                Key(
                    "stretching 1",
                    "N/m",
                    "C11 h/2: the program doubles it",
                    lambda c: c["lambda_h"] / 2 + c["mu_h"],
                ),
                Key("stretching 2", "N/m", "C12 h/2", lambda c: c["lambda_h"] / 2.0),
                Key("stretching 3", "N/m", "C22 h/2", lambda c: c["lambda_h"] / 2.0 + c["mu_h"]),
                Key(
                    "stretching 4",
                    "N/m",
                    "G h in the force; the printed energy has half of it",
                    lambda c: c["mu_h"],
                ),
                Key("bending", "N·m", "⅛ k L²/(A₁ + A₂) θ² of an edge", lambda c: 12.0 * c["hinge"]),
            ),
            "ArcSim as in DrapeTester/ClothDrapeTester, arcsim/AdaptiveCloth/physics.cpp: bending_energy («"
            "shape = sq(edge->l) / (2 * a); return ke * shape * sq(theta - …) / 4»), stretching_force («2 * "
            "k[3] * G(0, 1)»); dde.cpp: evaluate_stretching_sample («real_elastic[0] *= 2»); add_internal_"
            "forces («A = dt^2 J + dt damp J»)",
            HINGED + "; remeshing changes the hinges' weights: switch it off (refine_angle and the like)",
            licence="University of California, not for profit",
            dampers=(Key("damping", "s", TIMES_STIFFNESS, lambda c: c["damping_time"]),),
        ),
        Code(
            "c-ipc",
            "Codim-IPC",
            "height",
            (
                Key(
                    "E",
                    "Pa",
                    "the sheet's own: membrane times thickness, plane stress",
                    lambda c: _young_h(c) / c["thickness"],
                ),
                Key("nu", "", "the sheet's own", _plane_poisson),
                Key(
                    "thickness", "m", "the sheet's own; also the offset of contacts", lambda c: c["thickness"]
                ),
                DENSITY,
                Key(
                    "bendingStiffMult",
                    "",
                    "times E h³/24(1 − ν²) of θ² L/h̄, h̄ = (A₁ + A₂)/3L",
                    lambda c: c["hinge"] / _rigidity(c),
                ),
            ),
            "ipc-sim/Codim-IPC, Library/FEM/Shell/DISCRETE_SHELL.h («lambda = E * nu / (1 - nu * nu)», «k = "
            "E * std::pow(thickness, 3) / (24 * (1 - nu * nu))», h̄ = (|n1| + |n2|)/(6 |e|)); "
            "BENDING.h («k * (theta - thetabar) * (theta - thetabar) * ebarnorm / hbar»)",
            HINGED,
            licence="Apache-2.0",
        ),
        Code(
            "ppf",
            "ppf-contact-solver, model arap",
            "height",
            (
                AREAL,
                Key(
                    "young-mod",
                    "m²/s²",
                    "E′/ρ, with λ of a solid: 2 μ h (1 + poiss-rat) over the density per area",
                    lambda c: 2.0 * c["mu_h"] * (1.0 + _spatial_poisson(c)) / (c["density"] * c["thickness"]),
                ),
                Key("poiss-rat", "", "of a solid, not of plane stress: ν/(1 + ν)", _spatial_poisson),
                Key(
                    "bend",
                    "m⁴/s²",
                    "½ 1.28e-5 bend ρ_A L²/(A₁ + A₂) θ², called dimensionless there",
                    lambda c: 3.0 * c["hinge"] / (BEND_SCALE * c["density"] * c["thickness"]),
                ),
            ),
            "st-tech/ppf-contact-solver, crates/ppf-cts-solver/src/cpp/energy/energy.cu: embed_hinge_force_"
            "hessian («BEND_SCALE * bend_dir * (length * length / area) * areal_density»), embed_face_force_"
            "hessian («mass * …»); builder.rs: convert_prop (λ of a solid); crates/ppf-cts-core/src/"
            "datamodel/params.rs («pre-normalized by density (units of Pa/rho)», density in kg/m²)",
            HINGED,
            licence="Apache-2.0",
        ),
        Code(
            "openusd",
            "OpenUSD, deformables proposal as Newton 1.8 reads it",
            "length",
            (
                DENSITY,
                Key(
                    "thickness",
                    "m",
                    "the sheet's own: physics:thicknesses of the mesh",
                    lambda c: c["thickness"],
                ),
                Key("physics:youngsModulus", "Pa", "the sheet's own", lambda c: _young_h(c) / c["thickness"]),
                Key("physics:poissonsRatio", "", "the sheet's own", _plane_poisson),
                Key(
                    "physics:surfaceStretchStiffness",
                    "N/m",
                    "E h/(1 − ν²): times thickness",
                    lambda c: c["lambda_h"] + 2.0 * c["mu_h"],
                ),
                Key("physics:surfaceShearStiffness", "N/m", "G h: times thickness", lambda c: c["mu_h"]),
                Key(
                    "physics:surfaceBendStiffness",
                    "N·m",
                    "E h³/12(1 − ν²), of the sheet and not of an edge",
                    _rigidity,
                ),
            ),
            "newton-physics/newton 1.8.0, newton/_src/utils/import_usd_deformable_cloth.py: _resolve_surface_"
            "structural_stiffnesses («youngs * thickness / plane_stress», «youngs * thickness**3 / (12.0 * "
            "plane_stress)»)",
            "the bending stiffness is the sheet's [N·m], to be converted to hinges by programs. Newton 1.8 "
            "reads it as edge_ke [N], which it multiplies by the edge's length, and sets tri_ka = 0: "
            "for Newton use the values of --for newton",
            licence="Apache-2.0 (modified)",
        ),
        Code(
            "discrete-shells",
            "Discrete shells (Grinspun et al. 2003)",
            "height",
            (Key("k_B", "N·m", "k θ² L/h̄ of an edge, h̄ = (A₁ + A₂)/3L", lambda c: c["hinge"] / 2.0),),
            "Grinspun et al., Discrete shells, SCA 2003, equation (1)",
            HINGED,
        ),
    )
}
