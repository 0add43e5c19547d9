"""What the fitted methods are fitted to: displacements and frequencies of given scenes, as plain data.

They come from a reference model or from measurements; whoever asks for a fit computes them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sheetbench.scenes import Scene


@dataclass(frozen=True)
class StaticTarget:
    """A scene and the mid-surface displacement (n, 3) [m] wanted at plan points (n, 2) [m]."""

    scene: Scene
    points: np.ndarray
    displacement: np.ndarray


@dataclass(frozen=True)
class ModalTarget:
    """A scene and the lowest natural frequencies (n,) [Hz] wanted of it."""

    scene: Scene
    frequencies: np.ndarray


Target = StaticTarget | ModalTarget
