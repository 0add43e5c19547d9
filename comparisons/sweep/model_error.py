"""The model error of a reference, on every mesh: bounds for thickness, law of strain and clamps.

thickness   (1.2 + 1.3 ν²) (h/a)², a the length that bends, 1.2 = 1/κ: shear-deformable plates and shells
            differ from the solid by terms of that order (Koiter, Proc. Kon. Ned. Ak. Wet. B73 (1970)
            169–195), the part with ν for the normal stress at clamps that no shell has. What bends over a
            length a shears by (h/a)² of the energy: of a cantilever 0.6/(1 − ν) (h/L)² under an end force,
            1.3/(1 − ν) (h/L)² under its weight. So (h/a)² is the energy of transverse shear over that of
            bending, of what stretches (h/s)², s the shorter side, and at most (h/s)². Strips of L/b = 5,
            h/b 0.25 to 1, ν 0 to 0.45, pressed, bent and pulled at a corner are 0.06 to 0.47 of that off the
            solid. The order is derived, the 1.3 is
            measured: on sheets with one, two and four clamps, ν −0.3 to 0.49, h/a 0.06 to 0.15, the solid
            with clamp "mean" is 0.04 to 1.02 (h/a)² from the shell (12 elements, two layers), and CalculiX
            in one of them 1.4 (h/a)². Clamps hold the mean over the thickness there: held on the mid-line
            alone a face is dented by the shear force, the more the finer the mesh is, and no bar holds
            that. Nothing for a solid.
            Or, where that is more, h/7.5 times the slope at which the shell leaves its clamp, the mean over
            h/2: what a section that cannot warp leaves out at a clamp dies away as exp(−7.5 x/h), the least
            root of sin 2z = 2z (Horgan & Knowles, Adv. Appl. Mech. 23 (1983) 179–269, flexure), so that
            within that length its whole rise is in doubt, and beyond it a taut sheet is as far off as there.
            It is more where a sheet is stretched so far that it turns within a thickness: 1.4 to 2.1 times
            what inflated squares and strips of rubber are off the solid with the mean held
strain law  1.3 times what Biot's and neo-Hooke's laws would move the probes by, to second order
            (`fem_reference.shell.other_laws`; 0.86 to 1.04 times that is what twelve sheets' moved by, the
            farther of both, at stretches up to 5 %). Where that is not known, of a solid and of sheets that
            are not the same all over, 2.3 ε √m, ε the largest stretch, m the share of stretching in the
            energy: at one force St Venant–Kirchhoff's and neo-Hooke's sheets differ by 2.3 ε of a stretch
            (P = E ε (1 + c ε + …), c = 1.5 and −0.77); m = 1 of layers that bend when pulled, whose bending
            stretches the mid-surface. Nothing where the user has chosen the law
            or the material has one: then it is part of the scene
clamp       0.75 |ν|/(1 − ν) h/a where an edge is clamped: a clamp holds the surface and its normal, and
            leaves the thickness free to change (docs/theory.md, section 8). One that holds the whole face
            stops the change of thickness that bending brings, within a zone of length h
hinge       0.85 h/a where an edge is hinged and its twist free: a thin square hinged all around, of which the
            hard simple support, Kirchhoff's, takes so much (h/a 0.01 to 0.05, ν 0.3; `twist = "held"`)

Shares of the largest displacement. The parts of clamps and hinges are no errors of the answer to the scene as
it is worded, but what other ones would change; so they stand beside the others and are not added to them.
Against the solid with either clamp, and the shell with the three laws, the bounds hold on the scenes of
`tests/comparisons/sweep/test_model_error.py`, h/a from 0.013 to 0.15.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from sheetbench.answers.solution import Solution, Status
from sheetbench.scenes import EDGES, Clamped, Curved, Hinged, Scene, Symmetric
from sheetbench.scenes.language.summary import few
from sheetbench.scenes.meaning.kinematics import UP, bent_or_tilted
from sheetbench.scenes.meaning.natural_state import plies_of
from sheetbench.scenes.objects.layers import bends_when_pulled
from sheetbench.scenes.objects.supports import holds_director, place, tilt_axes

MODELS = ("shell", "solid")
PARTS = ("membrane", "bending", "shear")
SHEAR, NORMAL = 1.2, 1.3
LAW, SECOND_ORDER = 2.3, 1.3
CLAMP, HINGE = 0.75, 0.85
DECAY, LEAVING = 7.498, 0.5  # per thickness; thicknesses
ALONG = 31  # points of an edge where its rise is looked at


@dataclass(frozen=True)
class ModelError:
    """Bounds, shares of the largest displacement; see the module. value: thickness and law of strain."""

    thickness: float
    strain_law: float
    clamp: float
    hinge: float = 0.0

    @property
    def value(self) -> float:
        """What the model leaves out of the scene as it is worded."""
        return self.thickness + self.strain_law

    def __str__(self) -> str:
        parts = {"thickness": self.thickness, "law of strain": self.strain_law}
        named = ", ".join(f"{name} {_percent(part)}" for name, part in parts.items() if part > 0.0)
        sentences = [f"model error ± {_percent(self.value)} ({named})"] if named else []
        if self.clamp > 0.0:
            change = _percent(self.clamp)
            sentences.append(f"if the clamp also stops the sheet from thinning, add up to {change}")
        if self.hinge > 0.0:
            change = _percent(self.hinge)
            sentences.append(f'with hard simple supports, twist = "held", it moves up to {change} less')
        return "; ".join(sentences)

    def as_dict(self) -> dict[str, float | dict[str, float]]:
        """For JSON."""
        parts = {"thickness": self.thickness, "strain_law": self.strain_law}
        return {"model": self.value, "model_parts": parts, "clamp": self.clamp, "hinge": self.hinge}


def _percent(share: float) -> str:
    return f"{few(100.0 * share)} %"


def model_error(scene: Scene, answer: Solution, law_chosen: bool = False) -> ModelError | None:
    """Return the bounds of a shell's or solid's answer; None where it is no stable equilibrium, and of the
    plate, which leaves out large displacements altogether. law_chosen: whether its law of strain is the
    user's."""
    if answer.status is not Status.CONVERGED or answer.stretch is None or answer.model not in MODELS:
        return None
    slenderness, poisson = scene.sheet.thickness / min(_whole(scene)), scene.material.poisson
    square = _over_length_that_bends(slenderness**2, answer.energies)
    clamped = any(isinstance(support, Clamped | Curved) for support in scene.supports)
    soft = any(isinstance(support, Hinged) and not tilt_axes(support) for support in scene.supports)
    stated = scene.material.law is not None and answer.settings.get("law") == scene.material.law
    solid = answer.model == "solid"
    return ModelError(
        thickness=0.0 if solid else max((SHEAR + NORMAL * poisson**2) * square, _rise(scene, answer)),
        strain_law=0.0 if law_chosen or stated else _strain_law(scene, answer),
        clamp=CLAMP * abs(poisson) / (1.0 - poisson) * slenderness if clamped else 0.0,
        hinge=HINGE * slenderness if soft else 0.0,
    )


def _over_length_that_bends(square: float, energies: Mapping[str, float]) -> float:
    """Return (h/a)² of an answer's energies [J] by part, a the length that bends; square: (h/s)², s the
    shorter side."""
    membrane, bending, shear = (max(0.0, energies.get(part, 0.0)) for part in PARTS)
    whole = membrane + bending
    return min(square, (shear + membrane * square) / whole) if whole > 0.0 else square


def _whole(scene: Scene) -> list[float]:
    """Return the sides [m] of the sheet of which planes of symmetry leave a part; infinite between two."""
    planes = [EDGES[one.edge].normal_axis for one in scene.supports if isinstance(one, Symmetric)]
    return [side * (1.0, 2.0, np.inf)[planes.count(axis)] for axis, side in enumerate(scene.sheet.lengths)]


def _rise(scene: Scene, answer: Solution) -> float:
    """Return h/7.5 times the slope at which the sheet leaves a clamp, along its director, where that is most,
    as a share of the largest displacement at the probes."""
    largest = float(np.abs(answer.displacement(scene.probe_points())).max(initial=0.0))
    driven = {edge.edge: edge for edge in bent_or_tilted(scene.supports, scene.sheet)}
    rises = [0.0]
    for support in scene.supports:
        if place(support) is not None or not holds_director(support):
            continue
        edge, ends = EDGES[support.edge], np.array(scene.sheet.edge_ends(support.edge))
        points = ends[0] + np.linspace(0.0, 1.0, ALONG + 2)[1:-1, None] * (ends[1] - ends[0])
        step = np.zeros((1, 3))
        step[0, edge.normal_axis] = (-1.0 if edge.far_end else 1.0) * LEAVING * scene.sheet.thickness
        inside = np.ones(ALONG, bool)
        if scene.pierced:
            from shapely import contains_xy  # plain sheets do not wait for it

            inside = contains_xy(scene.region, *(points + 0.5 * step[:, :2]).T)
            inside &= contains_xy(scene.region, *(points + step[:, :2]).T)
        points = points[inside]
        turned = driven[support.edge].placed(points).director if support.edge in driven else 0.0
        moved = answer.displacement(points + step[:, :2]) - answer.displacement(points) + step
        rises.append(float(np.abs(np.sum(moved * (UP + turned), axis=1)).max(initial=0.0)))
    return max(rises) / (LEAVING * DECAY * largest) if largest > 0.0 else 0.0


def _strain_law(scene: Scene, answer: Solution) -> float:
    from fem_reference.shell.other_laws import shift

    stretch = answer.stretch or 0.0
    if answer.model == "solid":
        return LAW * stretch
    if (moved := shift(scene, answer)) is not None:
        return SECOND_ORDER * moved
    membrane = answer.energies.get("membrane", 0.0) / (sum(answer.energies.values()) or 1.0)
    unlike = scene.layers and bends_when_pulled(plies_of(scene))
    return float(LAW * stretch * (1.0 if unlike else membrane**0.5))


def left_for_grid(tolerance: float, model_error: float | None) -> float:
    """Return what is left of a tolerance for the error of a grid or mesh and the reference's own bar, once
    what the reference leaves out is taken off: all of it where that alone is above the tolerance, which then
    is met against a converged reference only."""
    taken = model_error or 0.0
    return tolerance if taken >= tolerance else tolerance - taken


def share_of_tolerance(tolerance: float, model_error: float | None, bar: float | None, reference: str) -> str:
    """Return in a sentence what model error and bar of a reference take of a tolerance."""
    allowed, known = _percent(tolerance), 0.0 if bar is None else bar
    left = left_for_grid(tolerance, model_error) - known
    if (model_error or 0.0) >= tolerance:
        return (
            f"Of {allowed} the {reference}'s model error would take {_percent(model_error or 0.0)}, more "
            f"than all of it: within {allowed} of a converged {reference} only."
        )
    parts = [f"its mesh's bar {_percent(known)}"] if bar is not None else []
    if model_error:
        parts.insert(0, f"the {reference}'s model error takes {_percent(model_error)}")
    if not parts:
        return ""
    return f"Of {allowed} {', '.join(parts)}: {_percent(max(left, 0.0))} are left for the grid."
