"""The model error of a reference, on every mesh: bounds for thickness, law of strain and clamps.

thickness   (1.2 + 1.3 ν²) (h/a)², a the length of bending, 1.2 = 1/κ. Shear-deformable plates and shells
            differ from the solid by terms of this order (Koiter, Proc. Kon. Ned. Ak. Wet. B73 (1970)
            169–195); the term with ν is for the normal stress at clamps, which shells lack. Bending over a
            length a has a fraction (h/a)² of its energy in shear: for a cantilever 0.6/(1 − ν) (h/L)² under
            an end force, 1.3/(1 − ν) (h/L)² under its weight. So (h/a)² is taken as the energy of transverse
            shear over the energy of bending, for stretching as (h/s)², s the shorter side, and at most as
            (h/s)². Strips of L/b = 5, h/b 0.25 to 1, ν 0 to 0.45, pressed, bent and pulled at a corner differ
            from the solid by 0.06 to 0.47 of it. The order is derived, the 1.3 is measured: on sheets with
            one, two and four clamps, ν −0.3 to 0.49, h/a 0.06 to 0.15, the solid with clamp "mean" differs
            from the shell by 0.04 to 1.02 (h/a)² (12 elements, two layers), in one of them CalculiX by 1.4
            (h/a)². These clamps hold the mean over the thickness; in a face held on the mid-line alone, the
            shear force makes a dent that grows with refinement and that no bound covers. The bound of a solid
            is 0. A larger value is taken from h/7.5 times the slope, averaged over h/2, at which the shell
            leaves its clamp: the error of a section that cannot warp decays from a clamp as exp(−7.5 x/h),
            the least root of sin 2z = 2z (Horgan & Knowles, Adv. Appl. Mech. 23 (1983) 179–269, flexure).
            The whole deflection within this length is uncertain, and a taut sheet keeps this error beyond it.
            This value is larger for sheets stretched so far that they turn within a thickness: 1.4 to 2.1
            times the error of inflated squares and strips of rubber from the solid with the mean held
strain law  1.3 times the displacement of the probes by a change to Biot's or neo-Hooke's law, to second order
            (`fem_reference.shell.other_laws`; twelve sheets moved by 0.86 to 1.04 times the larger of both,
            at stretches up to 5 %). For solids and nonuniform sheets, 2.3 ε √m, ε the largest stretch, m the
            fraction of stretching in the energy: under equal forces the stretches of St Venant–Kirchhoff's
            and neo-Hooke's sheets differ by 2.3 ε (P = E ε (1 + c ε + …), c = 1.5 and −0.77); m = 1 for
            layers that bend when pulled, because their bending stretches the mid-surface. The bound is 0 if
            the user chose the law or the material has one, because the law is then part of the scene
clamp       0.75 |ν|/(1 − ν) h/a for clamped edges: a clamp holds the surface and its normal, but not the
            thickness (docs/theory.md, section 8). A clamp of the whole face also prevents the change of
            thickness in bending, within a zone of length h
hinge       0.85 h/a for hinged edges with free twist: the change of a thin square, hinged all around, by a
            hard simple support, Kirchhoff's (h/a 0.01 to 0.05, ν 0.3; `twist = "held"`)

All are fractions of the largest displacement. The parts of clamps and hinges are not errors of the scene as
described, but the effect of other supports; they are listed separately and not added to the others. The
bounds hold against the solid with either clamp, and the shell with the three laws, on the scenes of
`tests/comparisons/sweep/test_model_error.py`, h/a from 0.013 to 0.15.
"""

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
ALONG = 31  # points of an edge at which its slope is taken


@dataclass(frozen=True)
class ModelError:
    """Bounds of the model error, fractions of the largest displacement, as the module defines them."""

    thickness: float
    strain_law: float
    clamp: float
    hinge: float = 0.0

    @property
    def value(self) -> float:
        """Bound for the scene as described: thickness and law of strain together."""
        return self.thickness + self.strain_law

    def __str__(self) -> str:
        parts = {"thickness": self.thickness, "law of strain": self.strain_law}
        listed = ", ".join(f"{name} {few_percent(part)}" for name, part in parts.items() if part > 0.0)
        sentences = [f"model error ± {few_percent(self.value)} ({listed})"] if listed else []
        if self.clamp > 0.0:
            sentences.append(f"add up to {few_percent(self.clamp)} if the clamp also holds the thickness")
        if self.hinge > 0.0:
            sentences.append(
                f'subtract up to {few_percent(self.hinge)} for hard simple supports, twist = "held"'
            )
        return "; ".join(sentences)

    def as_dict(self) -> dict[str, float | dict[str, float]]:
        """Return the bounds as JSON data."""
        parts = {"thickness": self.thickness, "strain_law": self.strain_law}
        return {"model": self.value, "model_parts": parts, "clamp": self.clamp, "hinge": self.hinge}


def few_percent(share: float) -> str:
    """Return a fraction as text in per cent, with few digits."""
    return f"{few(100.0 * share)} %"


def model_error(scene: Scene, answer: Solution, law_chosen: bool = False) -> ModelError | None:
    """Return the bounds of a shell's or solid's answer, None for other answers. Unstable answers and the
    plate, which is linear, have no bounds. law_chosen: whether the user chose the law of strain."""
    if answer.status is not Status.CONVERGED or answer.stretch is None or answer.model not in MODELS:
        return None
    slenderness, poisson = scene.sheet.thickness / min(_whole_sides(scene)), scene.material.poisson
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
    """Return (h/a)² from energies [J] by part, a the length of bending; square: (h/s)², s the side."""
    membrane, bending, shear = (max(0.0, energies.get(part, 0.0)) for part in PARTS)
    whole = membrane + bending
    return min(square, (shear + membrane * square) / whole) if whole > 0.0 else square


def _whole_sides(scene: Scene) -> list[float]:
    """Return the sides [m] of the whole sheet if planes of symmetry cut it; infinite between two planes."""
    planes = [EDGES[s.edge].normal_axis for s in scene.supports if isinstance(s, Symmetric)]
    return [side * (1.0, 2.0, np.inf)[planes.count(axis)] for axis, side in enumerate(scene.sheet.lengths)]


def _rise(scene: Scene, answer: Solution) -> float:
    """Return h/7.5 times the largest slope at which the sheet leaves a clamp, relative to its director, over
    the largest displacement at the probes."""
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
            from shapely import contains_xy  # slow import, not needed for plain sheets

            inside = contains_xy(scene.region, *(points + 0.5 * step[:, :2]).T)
            inside &= contains_xy(scene.region, *(points + step[:, :2]).T)
        points = points[inside]
        director = UP + (driven[support.edge].displaced(points).director if support.edge in driven else 0.0)
        chord = answer.displacement(points + step[:, :2]) - answer.displacement(points) + step
        rises.append(float(np.abs(np.sum(chord * director, axis=1)).max(initial=0.0)))
    return max(rises) / (LEAVING * DECAY * largest) if largest > 0.0 else 0.0


def _strain_law(scene: Scene, answer: Solution) -> float:
    from fem_reference.shell.other_laws import shift

    stretch = answer.stretch or 0.0
    if answer.model == "solid":
        return LAW * stretch
    if (change := shift(scene, answer)) is not None:
        return SECOND_ORDER * change
    membrane = answer.energies.get("membrane", 0.0) / (sum(answer.energies.values()) or 1.0)
    coupled = scene.layers and bends_when_pulled(plies_of(scene))
    return float(LAW * stretch * (1.0 if coupled else membrane**0.5))


def left_for_grid(tolerance: float, model_error: float | None) -> float:
    """Return the part of a tolerance that is left for the grid's error and the reference's bar: the tolerance
    minus the model error. If the latter exceeds the tolerance, the whole tolerance is returned and refers to
    a converged reference."""
    part = model_error or 0.0
    return tolerance if part >= tolerance else tolerance - part


def share_of_tolerance(tolerance: float, model_error: float | None, bar: float | None, reference: str) -> str:
    """Return a sentence on the parts of a tolerance: model error and bar of a reference, and the rest."""
    allowed, bar_value = few_percent(tolerance), 0.0 if bar is None else bar
    rest = left_for_grid(tolerance, model_error) - bar_value
    if (model_error or 0.0) >= tolerance:
        return (
            f"The {reference}'s model error, {few_percent(model_error or 0.0)}, exceeds {allowed}: the "
            f"answer is within {allowed} of a converged {reference} only."
        )
    parts = [f"its mesh's bar {few_percent(bar_value)}"] if bar is not None else []
    if model_error:
        parts.insert(0, f"the {reference}'s model error takes {few_percent(model_error)}")
    if not parts:
        return ""
    return f"Of {allowed} {', '.join(parts)}: {few_percent(max(rest, 0.0))} are left for the grid."
