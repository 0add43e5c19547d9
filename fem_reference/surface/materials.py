"""Linear elasticity of a thin sheet: plane-stress St Venant–Kirchhoff, σ_zz = 0; isotropic

Voigt order [xx, yy, 2xy]; per unit of mid-surface area, with thickness h:

    membrane  N = h C E,           C = E/(1 − ν²) [[1, ν, 0], [ν, 1, 0], [0, 0, (1 − ν)/2]]   [Pa]
    bending   M = h³/12 C κ
    shear     Q = k h G γ,         G = E/2(1 + ν),   k = 5/6 (Reissner)

A sheet with fibres has the section of its plies (`fem_reference.surface.plies`). A `Section` given instead
makes the sheet any other plate, a lattice's homogenised one for instance.
"""

from typing import NamedTuple

import numpy as np

from fem_reference.surface import plies
from fem_reference.surface.biquadratic import AT_GAUSS, IN_PLANE, pulled_back
from sheetbench.scenes import Constants, Material, Scene
from sheetbench.scenes.meaning.composition import constants_at, of_sheet
from sheetbench.scenes.meaning.natural_state import held_at_drawn_size

SHEAR_CORRECTION = 5.0 / 6.0


class Section(NamedTuple):
    """Stiffness of the sheet per unit of its width, in Voigt order. Membrane A (3, 3) [N/m], bending D (3, 3)
    [N·m], shear (2, 2) [N/m] and mixed B (3, 3) [N], with N = A E + B κ and M = B E + D κ; of a nonuniform
    sheet at the Gauss points, (m, 9, …)."""

    membrane: np.ndarray
    bending: np.ndarray
    shear: np.ndarray
    mixed: np.ndarray = np.zeros((3, 3))


def constants_of(scene: Scene, corners: np.ndarray) -> Constants:
    """Return a scene's constants at the Gauss points of elements with nodes (m, 9, 2) [m]. They are numbers
    for a uniform sheet, else (m, 9)."""
    return constants_at(scene, AT_GAUSS[0] @ corners)


def section_at(scene: Scene, corners: np.ndarray) -> Section:
    """Return the section of a scene's sheet at the Gauss points of elements with nodes (m, 9, 2) [m]."""
    constants = constants_of(scene, corners)
    return section_of(constants, constants.thickness)


def green(stretch: np.ndarray) -> np.ndarray:
    """Return E0 = ½ (U² − 1) of U − 1 (…, 2, 2), for sheets that are not flat at rest.

    A law of strain takes E − E0(z) with the natural stretch U(z) = 1 + e0 − z k0 at the height z
    (`scenes.objects.natural`), of a shell to first order in z

        E0 = e0 + ½ e0²,    κ0 = −k0 − ½ (e0 k0 + k0 e0) = ½ (E0(1) − E0(−1)),

    and its energy is per natural area: strains of the natural sides are U⁻¹ (E − E0) U⁻¹, areas det U times
    as large, with the mid-surface's U = 1 + e0 at the full load factor. Elements sample E0 where they sample
    E."""
    return np.asarray(stretch + 0.5 * stretch @ stretch)


def grown(section: Section, strain: np.ndarray) -> Section:
    """Return the section per area and strain of the drawn sheet from a natural one; strain: e0 (…, 2, 2)."""
    stretch = np.eye(2) + strain
    inverse, area = np.linalg.inv(stretch), np.linalg.det(stretch)[..., None, None]
    turn = pulled_back(inverse, IN_PLANE)
    back = area * turn.swapaxes(-1, -2)
    shear = area * inverse @ section.shear @ inverse
    membrane, bending, mixed = (back @ k @ turn for k in (section.membrane, section.bending, section.mixed))
    return Section(membrane, bending, shear, mixed)


def stretched(scene: Scene) -> Scene:
    """Return the scene with the natural strain that gives its pretension. The stress of that strain, referred
    to the natural sides, is the tension of a sheet held at its drawn size, where the stretch is 1."""

    def tension(strain: np.ndarray) -> np.ndarray:
        inside = strain[[[0, 2], [2, 1]]]
        stretch, sheet = np.eye(2) + inside, of_sheet(scene)
        turn = pulled_back(np.linalg.inv(stretch), IN_PLANE)
        section = section_of(sheet, sheet.thickness).membrane
        by = [1.0, 1.0, 2.0] * green(inside)[[0, 1, 0], [0, 1, 1]]
        return -np.linalg.det(stretch) * turn.T @ section @ turn @ by

    return held_at_drawn_size(scene, tension)


def section_of(material: Material | Constants, thickness: float) -> Section:
    """Return the section of a sheet of a material, homogeneous through its thickness, or of its plies."""
    if isinstance(material, Constants) and material.plies:
        return Section(*plies.section(material.plies, thickness))
    stretch = plane_stress(material)
    shear = times(SHEAR_CORRECTION * thickness * shear_modulus(material), np.eye(2))
    return Section(times(thickness, stretch), times(thickness**3 / 12.0, stretch), shear)


def plane_stress(material: Material | Constants) -> np.ndarray:
    """Return C (…, 3, 3) [Pa]: stress [xx, yy, xy] of strain [xx, yy, 2xy]."""
    nu = np.asarray(material.poisson)
    form = np.zeros((*nu.shape, 3, 3), np.result_type(float, nu))
    form[..., 0, 0] = form[..., 1, 1] = 1.0
    form[..., 0, 1] = form[..., 1, 0] = nu
    form[..., 2, 2] = (1.0 - nu) / 2.0
    return times(material.young / (1.0 - nu**2), form)


def shear_modulus(material: Material | Constants) -> float:
    """Return G = E/2(1 + ν) [Pa]."""
    return material.young / (2.0 * (1.0 + material.poisson))


def times(factor: float | np.ndarray, form: np.ndarray) -> np.ndarray:
    """Return forms (…, k, k) times numbers (…)."""
    return np.asarray(factor)[..., None, None] * form
