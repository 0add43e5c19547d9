"""Sheets that are not flat at rest: their strains are those from the natural state.

With the natural stretch U(z) = 1 + e0 − z k0 at the height z (`scenes.objects.natural`) a law of strain
takes E − E0(z), 2 E0 = U² − 1, of a shell to first order in z

    E0 = e0 + ½ e0²,    κ0 = −k0 − ½ (e0 k0 + k0 e0) = ½ (E0(1) − E0(−1)),

and its energy is that per natural area: strains of the natural sides are U⁻¹ (E − E0) U⁻¹, areas det U times
as large, U = 1 + e0 that of the mid-surface at the full share. Elements sample E0 where they sample E.
"""

from __future__ import annotations

import numpy as np


def green(stretch: np.ndarray) -> np.ndarray:
    """½ (U² − 1) of U − 1 (…, 2, 2)."""
    return np.asarray(stretch + 0.5 * stretch @ stretch)
