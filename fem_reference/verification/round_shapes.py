"""Sheets with round rims: a disc clamped at its hub and its frequencies, a pulled strip with a hole, a lifted
slit annulus, a thick elliptic plate.

    bending      w = q r⁴/64D + C₁ + C₂ r² + C₃ ln r + C₄ r² ln r  of a thin disc held for r ≤ b, free at a,
                 and by shear  w = q/2κGh (a² ln r/b − (r² − b²)/2)
    frequencies  W = A J_n + B Y_n + C I_n + D K_n of λ r/a,  f = λ² √(D/ρh)/2πa²
    strip        largest stress at the hole over the mean beside it far away, by the hole's share of the width

The constants follow from w = w′ = 0 at b and from zero moment and effective shear force at a. The order is
measured on a thicker disc, on meshes whose elements are cut in four: curvatures of biquadratic tilts have
errors of order 2, deflections of order 4 (Aubin and Nitsche), and so have sides through three points of a
circle; orders are whole numbers, half of one distinguishes them. Elements of length l that are no
parallelograms add an error like l⁶/h² by their shear strain, which hides the order in thin discs. The stress
at the rim of a hole goes along it, σ = E ε, with the stretch ε of the rim's side.

Slit annulus: E 21e6, ν 0, radii 6 and 10, thickness 0.03, one side of the slit clamped, a force of 0.8 per
length of the other, which rises nearly as high as the plate is wide. A and B are its inner and outer end.

NAFEMS LE10: a quarter of the plate between the ellipses with half axes 2 and 1 m and 3.25 and 2.75 m, 0.6 m
thick, E 210 GPa, ν 0.3, 1 MPa on the upper face. Held: the outer face in the plane, its mid-line in z too,
and the sides by symmetry. Quantity: σ_yy at D, the inner ellipse's long end, on the upper face: −5.38 MPa.
The displacement gradient at the node gives the stress, so the mesh shrinks towards the inner ellipse. Plain
27-node bricks on meshes graded to D give −5.41 to −5.42 MPa, 0.6 % from the target, with σ_xx and σ_zz + 1
MPa below 0.02 MPa there: hence the tolerance.

Sources: Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells (1959), art. 17; Leissa, Vibration of
Plates, NASA SP-160 (1969), ch. 2; Howland, Phil. Trans. R. Soc. A 229 (1930) 49–86, of a strip with a hole;
Sze, Liu & Lo, Finite Elements in Analysis and Design 40 (2004) 1551–1569, section 3.3; NAFEMS, The Standard
NAFEMS Benchmarks (1990), test LE10.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import brentq
from scipy.special import iv, ivp, jv, jvp, kv, kvp, yv, yvp
from skfem import ElementHex2, MeshQuad, MeshQuad2

from fem_reference.discrete.answer import solve_on
from fem_reference.plate.discrete import DiscretePlate
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.solid.element import shape
from fem_reference.solid.materials import lame
from fem_reference.surface.biquadratic import AT_GAUSS, areas
from fem_reference.surface.loads import Line, spread
from fem_reference.surface.materials import section_of
from fem_reference.surface.mesh import mesh_of, plan_of, quarters
from fem_reference.surface.placement import mesh_of_cells
from fem_reference.verification.rows import THEORY, Row, absolute_row, curve, relative_row
from fem_reference.verification.specimens import linear_step, specimen, u_at, valid
from fem_reference.vibration import modes
from sheetbench.scenes import Clamped, EdgeLoad, Material, Scene, Sheet, Symmetric
from sheetbench.scenes.objects.cutouts import Cutout
from sheetbench.scenes.objects.shapes import Circle, Shape

TOLERANCE, OF_FREQUENCY, OF_ORDER = 5e-3, 1e-2, 0.5
ELEMENTS, ACROSS = 32, 48  # of the disc, of the strip's width
UNCUT = 8  # elements of the disc that are cut in four
RADIUS, HUB, THICK, LOAD = 1.0, 0.3, 2e-3, 0.1
THICKER = 0.1
METAL = Material(young=200e9, poisson=1.0 / 3.0, density=8000.0)
HOWLAND = {0.2: 3.14, 0.5: 4.32}  # by the hole's diameter over the strip's width
CORNERS = 512

RADIAL, AROUND = 6, 48  # of the annulus
LIFTED = {
    0.1: (4.277, 5.876),
    0.25: (7.602, 10.288),
    0.5: (10.468, 13.768),
    0.75: (12.310, 15.842),
    1.0: (13.891, 17.528),
}

BRICKS, WITHIN, GRADING = (8, 12, 6), 1e-2, 1.5  # of the elliptic plate: radial, around and layers
PRESSURE = 1e6
STEEL = Material(young=210e9, poisson=0.3, density=7800.0)

Side = tuple[int, float]


def disc(thick: float = THICK) -> Scene:
    """Return a disc clamped at its hub under a force per area that grows as the cube of the thickness [m]."""
    turn = 2.0 * np.pi * np.arange(CORNERS) / CORNERS
    outline = RADIUS * (1.0 + np.column_stack([np.cos(turn), np.sin(turn)]))
    sheet = Sheet(2.0 * RADIUS, 2.0 * RADIUS, thick, outline=tuple((x, y) for x, y in outline.tolist()))
    hub = Clamped.model_validate({"where": Shape(circle=Circle(centre=(RADIUS, RADIUS), radius=HUB))})
    return specimen(sheet, METAL, (hub,), LOAD * (thick / THICK) ** 3)


def bending() -> Iterator[Row]:
    """Yield the deflection of the rim, and the order of convergence of plate and shell."""
    thin, thicker, at_rim = disc(), disc(THICKER), (2.0 * RADIUS, RADIUS)
    coarse = cut(mesh_of(thicker, UNCUT))
    meshes = coarse, cut(coarse)
    for kind in (DiscretePlate, DiscreteShell):
        model, source = kind.model, "Timoshenko 1959, art. 17"
        mesh, w = f"{model} {ELEMENTS} × {ELEMENTS}", u_at(thin, at_rim, model, ELEMENTS)[2]
        yield relative_row("deflection of the rim [m]", mesh, deflection_at_rim(), source, w, TOLERANCE)
        answers = (solve_on(kind, refined, thicker) for refined in meshes)
        rims = [answer.displacement(np.array([at_rim]))[0, 2] for answer in answers]
        errors = [abs(rim - deflection_at_rim(THICKER)) for rim in rims]
        quantity, mesh = f"order, h/a = {THICKER / RADIUS:g}", f"{model} {UNCUT} × {UNCUT}, cut in 4 and 16"
        yield absolute_row(quantity, mesh, 4.0, THEORY, np.log2(errors[0] / errors[1]), OF_ORDER)


def cut(mesh: MeshQuad) -> MeshQuad2:
    """Return the disc's mesh with each element cut in four, and with the nodes of rim and hub on circles."""
    plan = plan_of(mesh)
    fine = MeshQuad2.from_mesh(mesh_of_cells(plan.nodes, quarters(plan.elements.T)))
    centred = fine.doflocs - RADIUS
    part = np.append(np.hypot(*centred[:, fine.t].mean(axis=1)) > HUB, 2)  # 2: beyond the rim
    border = np.flatnonzero(part[fine.f2t[0]] != part[fine.f2t[1]])
    nodes = np.concatenate([fine.facets[:, border].ravel(), fine.dofs.facet_dofs[0, border]])
    distance = np.hypot(*centred[:, nodes])
    centred[:, nodes] *= np.where(2.0 * distance > RADIUS + HUB, RADIUS, HUB) / distance
    corners, sides, (centres,) = np.split(fine.dofs.element_dofs, [4, 8])
    centred[:, centres] = 0.5 * centred[:, sides].sum(axis=1) - 0.25 * centred[:, corners].sum(axis=1)
    return replace(fine, doflocs=centred + RADIUS)


def frequencies() -> Iterator[Row]:
    """Yield the lowest frequency for each number of nodal diameters up to 2."""
    rigidity = section_of(METAL, THICK).bending[0, 0]
    scene, scale = disc(), np.sqrt(rigidity / (METAL.density * THICK)) / (2.0 * np.pi * RADIUS**2)
    for model in ("plate", "shell"):
        values = modes(scene, model, ELEMENTS, count=5).frequencies / scale
        mesh, by_diameters = f"{model} {ELEMENTS} × {ELEMENTS}", {1: values[:2], 0: values[2], 2: values[3:5]}
        for n, pair in by_diameters.items():
            quantity, source = f"λ² with {n} nodal diameters", "Leissa 1969, ch. 2"
            yield relative_row(quantity, mesh, frequency(n), source, np.mean(pair), OF_FREQUENCY)


def strip_with_hole() -> Iterator[Row]:
    """Yield the largest stress at the hole over the mean one far away."""
    for share, published in HOWLAND.items():
        quantity, mesh = f"stress at a hole of {share:g} of the width", f"plate {ACROSS} across"
        yield relative_row(quantity, mesh, published, "Howland 1930", concentration(share), TOLERANCE)


def slit_annulus() -> Iterator[Row]:
    """Yield the rise of both ends of the lifted side at each share of the force."""
    names, mesh = ("w_A at P = {:g} P_max", "w_B at P = {:g} P_max"), f"shell {RADIAL} × {AROUND}"
    source, at = "Sze, Liu & Lo 2004, 3.3", min(LIFTED)
    yield from curve(names, {"shell": mesh}, LIFTED, source, TOLERANCE, rise, RADIAL, half_at=at)


def elliptic_plate() -> Iterator[Row]:
    """Yield σ_yy [MPa] at D."""
    computed, mesh = stress_at_d(*BRICKS)[1, 1] / 1e6, f"solid {BRICKS[0]} × {BRICKS[1]} × {BRICKS[2]}"
    yield relative_row("σ_yy at D [MPa]", mesh, -5.38, "NAFEMS 1990, LE10", computed, WITHIN)


def deflection_at_rim(thick: float = THICK) -> float:
    """Return w [m] at a, of a disc of a thickness [m]."""
    nu, a, b = METAL.poisson, RADIUS, HUB

    def terms(r: float) -> np.ndarray:
        """Return w, w′, M/−D and (Δw)′ of q r⁴/64D and of 1, r², ln r, r² ln r."""
        log = np.log(r)
        first = np.array([4 * r**3, 0.0, 2 * r, 1 / r, r * (2 * log + 1)])
        second = np.array([12 * r**2, 0.0, 2.0, -1 / r**2, 2 * log + 3])
        w, shear = [r**4, 1.0, r**2, log, r**2 * log], [32 * r, 0.0, 0.0, 0.0, 4 / r]
        return np.array([w, first, second + nu / r * first, shear])

    at_hub, at_rim = terms(b), terms(a)
    rows, load = np.vstack([at_hub[:2], at_rim[2:]]), LOAD / (64.0 * section_of(METAL, THICK).bending[0, 0])
    constants = np.linalg.solve(rows[:, 1:], -load * rows[:, 0])
    stiffness = 5.0 / 6.0 * METAL.young / (2.0 + 2.0 * nu) * THICK**3 / thick**2
    by_shear = LOAD / (2.0 * stiffness) * (a**2 * np.log(a / b) - 0.5 * (a**2 - b**2))
    return float(load * at_rim[0, 0] + at_rim[0, 1:] @ constants + by_shear)


def frequency(n: int) -> float:
    """Return λ² of the lowest mode with n nodal diameters."""
    nu, b = METAL.poisson, HUB / RADIUS
    kinds = ((jv, jvp, -1.0), (yv, yvp, -1.0), (iv, ivp, 1.0), (kv, kvp, 1.0))

    def determinant(k: float) -> float:
        columns = []
        for value, slope, sign in kinds:  # Δ W = sign k² W
            w, first = value(n, k), k * slope(n, k)
            moment = sign * k**2 * w - (1.0 - nu) * (first - n**2 * w)
            shear = sign * k**3 * slope(n, k) + (1.0 - nu) * n**2 * (w - first)
            columns.append([value(n, k * b), k * slope(n, k * b), moment, shear])
        matrix = np.array(columns).T
        return float(np.linalg.det(matrix / np.abs(matrix).max(axis=1, keepdims=True)))

    at = np.linspace(0.5, 6.0, 200)
    signs = np.sign([determinant(k) for k in at])
    first = int(np.flatnonzero(signs[1:] != signs[:-1])[0])
    return float(brentq(determinant, at[first], at[first + 1]) ** 2)


def concentration(share: float) -> float:
    """Return the largest stress at a hole over the mean far away; share: its diameter over the width."""
    width, length, thick, pull = 1.0, 3.0, 1e-2, 1e3
    middle = (0.5 * length, 0.5 * width)
    hole = Cutout(shape=Shape(circle=Circle(centre=middle, radius=0.5 * share * width)))
    load = EdgeLoad("x1", (pull, 0.0, 0.0))
    sheet = Sheet(length, width, thick)
    scene = specimen(sheet, METAL, (Clamped("x0"),), cutouts=(hole,), loads=(load,))
    mesh = mesh_of(scene, ACROSS, graded=True)
    plan = plan_of(mesh)
    sides = plan.nodes[Line.along(plan, mesh.boundary_facets()).nodes]
    ends = sides[np.linalg.norm(sides[:, 1] - middle, axis=1) < 0.51 * share * width][:, [0, 2]]
    displacement = solve_on(DiscretePlate, mesh, scene).displacement(ends.reshape(-1, 2))[:, :2]
    step, stretch = (np.diff(at.reshape(ends.shape), axis=1)[:, 0] for at in (ends, displacement))
    along = np.sum(stretch * step, axis=1) / np.sum(step**2, axis=1)
    return float(METAL.young * along.max() * thick / pull)


def rise(model: str, share: float, radial: int) -> np.ndarray:
    """Return w (2,) [m] of the inner and the outer end of the annulus's lifted side. The slit is along θ = 0:
    y0 (θ = 0) and y1 (θ = 2π)."""
    sheet, material = Sheet(20.0, 20.0, 0.03), Material(young=21e6, poisson=0.0, density=1.0)
    lift = EdgeLoad(edge="y0", force_per_length=(0.0, 0.0, 0.8 * share))
    scene = specimen(sheet, material, (Clamped(edge="y1"),), loads=(lift,))
    radii = np.linspace(6.0, 10.0, radial + 1)
    angles = np.linspace(0.0, 2.0 * np.pi, radial * AROUND // RADIAL + 1)
    mesh = mapped(
        radii, angles, lambda r, turn: (r * np.cos(turn), r * np.sin(turn)), y0=(1, 0.0), y1=(1, 2.0 * np.pi)
    )
    solution = solve_on(DiscreteShell, mesh, scene)
    lifted = np.unique(mesh.facets[:, mesh.boundaries["y0"]])
    ends = lifted[np.argsort(np.hypot(*mesh.p[:, lifted]))[[0, -1]]]
    return solution.mesh.point_data["displacement"][ends, 2] * valid(solution)


def stress_at_d(radial: int, around: int, layers: int) -> np.ndarray:
    """Return the stress (3, 3) [Pa] at D of the elliptic plate, whose outer face is x1."""
    share, angles = np.linspace(0.0, 1.0, radial + 1) ** GRADING, np.linspace(0.0, np.pi / 2.0, around + 1)

    def place(outwards: np.ndarray, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return (2.0 + 1.25 * outwards) * np.cos(angle), (1.0 + 1.75 * outwards) * np.sin(angle)

    held = Symmetric("x0"), Symmetric("y0"), Clamped("x1")
    mesh = mapped(share, angles, place, x1=(0, 1.0), y0=(1, 0.0), x0=(1, np.pi / 2.0))
    sheet = DiscreteSolid(mesh, specimen(Sheet(3.25, 2.75, 0.6), STEEL, held), layers=layers)
    columns, plan, force = sheet.columns, sheet.plan, np.zeros_like(sheet.columns.positions)
    force[:, -1, 2:] = spread(plan, plan.elements, areas(plan.corners) @ AT_GAUSS[0], np.array([-PRESSURE]))
    displacement = sheet.displacement(linear_step(sheet, force.ravel()))
    at_d = int(np.argmin(np.hypot(plan.nodes[:, 0] - 2.0, plan.nodes[:, 1])))
    bricks = columns.stacks[:, columns.places[-1]]
    brick, corner = np.argwhere(bricks == (at_d + 1) * columns.levels - 1)[0]
    slope = shape(ElementHex2.doflocs[corner][:, None])[1][:, :, 0]
    rest, moved = (x.reshape(-1, 3)[bricks[brick]].T @ slope for x in (columns.positions, displacement))
    gradient = moved @ np.linalg.inv(rest)
    strain = 0.5 * (gradient + gradient.T)
    first, second = lame(STEEL)
    return first * np.trace(strain) * np.eye(3) + 2.0 * second * strain


def mapped(first: np.ndarray, second: np.ndarray, place: Callable[..., Any], **sides: Side) -> MeshQuad2:
    """Return the mesh with lines at two coordinates and nodes at `place` of them [m]. sides: by name the
    coordinate that is constant there, and its value."""
    on = {name: lambda x, axis=axis, at=at: np.isclose(x[axis], at) for name, (axis, at) in sides.items()}
    plan = MeshQuad.init_tensor(first, second).with_boundaries(on)
    mesh = MeshQuad2.from_mesh(plan)
    return replace(mesh, doflocs=np.array(place(*mesh.doflocs))).with_boundaries(plan.boundaries)
