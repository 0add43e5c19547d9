"""Sheets that are not flat at rest: their strains are those from the natural state.

With the natural stretch U(z) = 1 + e0 − z k0 at the height z (`scenes.objects.natural`) a law of strain
takes E − E0(z), 2 E0 = U² − 1, of a shell to first order in z

    E0 = e0 + ½ e0²,    κ0 = −k0 − ½ (e0 k0 + k0 e0),

and its energy is that per natural area: strains of the natural sides are U⁻¹ (E − E0) U⁻¹, areas det U times
as large, U = 1 + e0 that of the mid-surface at the full share. Elements sample E0 where they sample E, so
that a sheet in its natural shape has no strain.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fem_reference.surface.biquadratic import AT_GAUSS
from fem_reference.surface.materials import Section
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.natural_state import NaturalState, natural_at

Sample = Callable[[np.ndarray, np.ndarray], np.ndarray]


class NaturalStrains:
    """The natural strains of elements: now, (m, k), at a share and time that `grow` sets. sample: strains of
    e0 and k0 (m, k, 2, 2) at the sampling sites, as the elements have theirs."""

    def __init__(self, state: NaturalState, sample: Sample):
        self.state, self._sample = state, sample
        self._factors = np.array([np.nan])
        self.grow()

    def grow(self, share: float = 1.0, time: float | None = None) -> None:
        """Set the share of the natural state at a time [s], without one the last."""
        self.set(share * self.state.factors(time))

    def set(self, factors: np.ndarray) -> None:
        """Set so many times what each source of the natural state has."""
        if not np.array_equal(factors, self._factors):
            self._factors = factors
            self.now = self._sample(*self.state.at(factors))


class AtRest:
    """Elements as they are at rest. natural: their strains from the flat sheet, None where there are none."""

    natural: NaturalStrains | None = None

    def grow(self, share: float = 1.0, time: float | None = None) -> None:
        """Set the share of the natural strains at a time [s]."""
        if self.natural is not None:
            self.natural.grow(share, time)

    @property
    def grows(self) -> bool:
        """Whether the natural strains change over time."""
        return self.natural is not None and self.natural.state.moves

    @property
    def prestrain(self) -> np.ndarray | None:
        """Natural strains (m, k) at the share set; None of a sheet that is flat at rest."""
        return None if self.natural is None else self.natural.now


def green(stretch: np.ndarray) -> np.ndarray:
    """½ (U² − 1) of U − 1 (…, 2, 2)."""
    return np.asarray(stretch + 0.5 * stretch @ stretch)


def of_shell(strain: np.ndarray, curvature: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return E0 and κ0 (…, 2, 2) of e0 and k0."""
    mixed = strain @ curvature
    return green(strain), -curvature - 0.5 * (mixed + mixed.swapaxes(-1, -2))


def in_voigt(tensor: np.ndarray) -> np.ndarray:
    """[xx, yy, 2xy] (…, 3) of tensors (…, 2, 2)."""
    return np.stack([tensor[..., 0, 0], tensor[..., 1, 1], 2.0 * tensor[..., 0, 1]], axis=-1)


def at_gauss(scene: Scene, corners: np.ndarray) -> NaturalState | None:
    """Return the natural state at the Gauss points of elements with nodes (m, 9, 2) [m], None of none."""
    return natural_at(scene, AT_GAUSS[0] @ corners)


def shrink(scene: Scene, corners: np.ndarray) -> np.ndarray | None:
    """Return U⁻¹ (m, 9, 2, 2) at the Gauss points, None where nothing has grown."""
    state = at_gauss(scene, corners)
    strain = None if state is None else state.at(state.factors())[0]
    return None if strain is None or not strain.any() else np.linalg.inv(np.eye(2) + strain)


def grown(section: Section, scene: Scene, corners: np.ndarray) -> Section:
    """Return the section per area and strain of the sheet as drawn, of one per natural area and strain."""
    inverse = shrink(scene, corners)
    if inverse is None:
        return section
    turn = np.stack([in_voigt(inverse @ unit @ inverse) for unit in UNITS], axis=-1)
    area = 1.0 / np.linalg.det(inverse)[..., None, None]
    back = turn.swapaxes(-1, -2)
    return Section(
        area * back @ section.membrane @ turn,
        area * back @ section.bending @ turn,
        area * inverse @ section.shear @ inverse,
    )


UNITS = np.array([[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, 0.5], [0.5, 0.0]]])
