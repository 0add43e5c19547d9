"""Sheets with round rims: a disc clamped at its hub, its frequencies, and a strip with a hole, pulled.

    bending      w = q r⁴/64D + C₁ + C₂ r² + C₃ ln r + C₄ r² ln r  of a thin disc held for r ≤ b, free at a,
                 and by shear  w = q/2κGh (a² ln r/b − (r² − b²)/2)
    frequencies  W = A J_n + B Y_n + C I_n + D K_n of λ r/a,  f = λ² √(D/ρh)/2πa²
    strip        largest stress at the hole over the mean beside it far away, by the hole's share of the width

The constants are those of w = w′ = 0 at b and of no moment and no effective shear force at a. The order is
that of a thicker disc on meshes whose elements are cut in four: curvatures of biquadratic tilts have errors
of order 2, deflections twice that (Aubin and Nitsche), and so have sides through three points of a circle;
orders are whole numbers, half of one distinguishes them. In thin discs the shear strain of elements of
length l that are no parallelograms adds an error like l⁶/h², which hides that one. The stress at the rim of
a hole goes along it, σ = E ε, and ε is that of the rim's side: the stretch of a mid-node.
Sources: Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells (1959), art. 17; Leissa, Vibration of
Plates, NASA SP-160 (1969), ch. 2; Howland, Phil. Trans. R. Soc. A 229 (1930) 49–86, of a strip with a hole.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq
from scipy.special import iv, ivp, jv, jvp, kv, kvp, yv, yvp
from skfem import MeshQuad, MeshQuad2

from fem_reference.discrete.answer import solve_on
from fem_reference.plate.discrete import DiscretePlate
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.surface.loads import Line
from fem_reference.surface.materials import bending_stiffness
from fem_reference.surface.mesh import mesh_of, nodes_of, plan_of, quarters
from fem_reference.verification.rows import THEORY, Row, absolutely, relatively
from fem_reference.verification.specimens import moved, specimen
from fem_reference.vibration import modes
from sheetbench.scenes import Clamped, EdgeLoad, Material, Scene, Sheet
from sheetbench.scenes.objects.cutouts import Cutout
from sheetbench.scenes.objects.shapes import Circle, Shape

TOLERANCE, OF_FREQUENCY, OF_ORDER = 5e-3, 1e-2, 0.5
ELEMENTS, ACROSS = 32, 48  # of the disc, of the strip's width
UNCUT = 8  # elements of the disc that are cut in four
RADIUS, HUB, THICK, LOAD = 1.0, 0.3, 2e-3, 0.1
THICKER = 0.1
STEEL = Material(young=200e9, poisson=1.0 / 3.0, density=8000.0)
HOWLAND = {0.2: 3.14, 0.5: 4.32}  # by the hole's diameter over the strip's width
CORNERS = 512


def disc(thick: float = THICK) -> Scene:
    """Clamped at its hub under a force per area, like the cube of the thickness [m]."""
    turn = 2.0 * np.pi * np.arange(CORNERS) / CORNERS
    outline = RADIUS * (1.0 + np.column_stack([np.cos(turn), np.sin(turn)]))
    sheet = Sheet(2.0 * RADIUS, 2.0 * RADIUS, thick, outline=tuple((x, y) for x, y in outline.tolist()))
    hub = Clamped.model_validate({"where": Shape(circle=Circle(centre=(RADIUS, RADIUS), radius=HUB))})
    return specimen(sheet, STEEL, (hub,), LOAD * (thick / THICK) ** 3)


def bending() -> Iterator[Row]:
    """The deflection of the rim, and the order in which plate and shell come to it."""
    thin, thicker, at_rim = disc(), disc(THICKER), (2.0 * RADIUS, RADIUS)
    for model, kind in (("plate", DiscretePlate), ("shell", DiscreteShell)):
        quantity, mesh = "deflection of the rim [m]", f"{model} {ELEMENTS} × {ELEMENTS}"
        source, computed = "Timoshenko 1959, art. 17", moved(thin, at_rim, model, ELEMENTS)[2]
        yield relatively(quantity, mesh, deflection_at_rim(), source, computed, TOLERANCE)
        coarse = cut(mesh_of(thicker, UNCUT))
        found = [
            solve_on(kind, each, thicker).displacement(np.array([at_rim])) for each in (coarse, cut(coarse))
        ]
        errors = np.abs(np.array(found)[:, 0, 2] - deflection_at_rim(THICKER))
        quantity, mesh = f"order, h/a = {THICKER / RADIUS:g}", f"{model} {UNCUT} × {UNCUT}, cut in 4 and 16"
        yield absolutely(quantity, mesh, 4.0, THEORY, np.log2(errors[0] / errors[1]), OF_ORDER)


def cut(mesh: MeshQuad) -> MeshQuad2:
    """The disc's mesh with each element cut in four, and with the nodes of rim and hub on circles."""
    nodes, elements = (np.ascontiguousarray(each.T) for each in nodes_of(mesh))
    fine = MeshQuad2.from_mesh(MeshQuad(nodes, np.ascontiguousarray(quarters(elements).T)))
    at = fine.doflocs - RADIUS
    part = np.append(np.hypot(*at[:, fine.t].mean(axis=1)) > HUB, 2)  # 2: beyond the rim
    border = np.flatnonzero(part[fine.f2t[0]] != part[fine.f2t[1]])
    on = np.concatenate([fine.facets[:, border].ravel(), fine.dofs.facet_dofs[0, border]])
    distance = np.hypot(*at[:, on])
    at[:, on] *= np.where(2.0 * distance > RADIUS + HUB, RADIUS, HUB) / distance
    corners, sides, (centres,) = np.split(fine.dofs.element_dofs, [4, 8])
    at[:, centres] = 0.5 * at[:, sides].sum(axis=1) - 0.25 * at[:, corners].sum(axis=1)
    return replace(fine, doflocs=at + RADIUS)


def frequencies() -> Iterator[Row]:
    """The lowest of every number of nodal diameters up to 2."""
    scene, scale = disc(), np.sqrt(_rigidity() / (STEEL.density * THICK)) / (2.0 * np.pi * RADIUS**2)
    for model in ("plate", "shell"):
        found = modes(scene, model, ELEMENTS, count=5).frequencies / scale
        by_diameters = {1: found[:2].mean(), 0: found[2], 2: found[3:5].mean()}
        for diameters, computed in by_diameters.items():
            quantity, mesh = f"λ² with {diameters} nodal diameters", f"{model} {ELEMENTS} × {ELEMENTS}"
            expected, source = frequency(diameters), "Leissa 1969, ch. 2"
            yield relatively(quantity, mesh, expected, source, computed, OF_FREQUENCY)


def strip_with_hole() -> Iterator[Row]:
    """The largest stress at the hole over the mean one far away."""
    for share, published in HOWLAND.items():
        quantity, mesh = f"stress at a hole of {share:g} of the width", f"plate {ACROSS} across"
        yield relatively(quantity, mesh, published, "Howland 1930", concentration(share), TOLERANCE)


def _rigidity() -> float:
    return float(bending_stiffness(STEEL, THICK)[0, 0])


def deflection_at_rim(thick: float = THICK) -> float:
    """w [m] at a, of a disc of that thickness [m]."""
    nu, a, b = STEEL.poisson, RADIUS, HUB

    def moment(first: float, second: float, r: float) -> float:
        return second + nu / r * first

    def terms(r: float) -> np.ndarray:
        """w, w′, M/−D and (Δw)′ of q r⁴/64D and of 1, r², ln r, r² ln r."""
        log = np.log(r)
        w = [r**4, 1.0, r**2, log, r**2 * log]
        first = [4 * r**3, 0.0, 2 * r, 1 / r, r * (2 * log + 1)]
        second = [12 * r**2, 0.0, 2.0, -1 / r**2, 2 * log + 3]
        shear = [32 * r, 0.0, 0.0, 0.0, 4 / r]
        return np.array([w, first, [moment(f, s, r) for f, s in zip(first, second, strict=True)], shear])

    at_hub, at_rim = terms(b), terms(a)
    rows, load = np.vstack([at_hub[:2], at_rim[2:]]), LOAD / (64.0 * _rigidity())
    constants = np.linalg.solve(rows[:, 1:], -load * rows[:, 0])
    stiffness = 5.0 / 6.0 * STEEL.young / (2.0 + 2.0 * nu) * THICK**3 / thick**2
    by_shear = LOAD / (2.0 * stiffness) * (a**2 * np.log(a / b) - 0.5 * (a**2 - b**2))
    return float(load * at_rim[0, 0] + at_rim[0, 1:] @ constants + by_shear)


def frequency(diameters: int) -> float:
    """λ² of the lowest mode with so many nodal diameters."""
    n, nu, b = diameters, STEEL.poisson, HUB / RADIUS
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
    values = np.array([determinant(k) for k in at])
    first = int(np.flatnonzero(np.sign(values[1:]) != np.sign(values[:-1]))[0])
    return float(brentq(determinant, at[first], at[first + 1]) ** 2)


def concentration(share: float) -> float:
    """Largest stress at a hole of so much of a strip's width, over the mean one far away."""
    width, length, thick, pull = 1.0, 3.0, 1e-2, 1e3
    middle = (0.5 * length, 0.5 * width)
    hole = Cutout(shape=Shape(circle=Circle(centre=middle, radius=0.5 * share * width)))
    load = EdgeLoad("x1", (pull, 0.0, 0.0))
    sheet = Sheet(length, width, thick)
    scene = specimen(sheet, STEEL, (Clamped("x0"),), cutouts=(hole,), loads=(load,))
    mesh = mesh_of(scene, ACROSS, graded=True)
    solution = solve_on(DiscretePlate, mesh, scene)
    plan = plan_of(mesh)
    sides = plan.nodes[Line.along(plan, mesh.boundary_facets()).nodes]
    near = np.linalg.norm(sides[:, 1] - middle, axis=1) < 0.51 * share * width
    ends = sides[near][:, [0, 2]]
    moved = solution.displacement(ends.reshape(-1, 2))[:, :2].reshape(ends.shape)
    step = np.diff(ends, axis=1)[:, 0]
    along = np.sum(np.diff(moved, axis=1)[:, 0] * step, axis=1) / np.sum(step**2, axis=1)
    return float(STEEL.young * along.max() * thick / pull)
