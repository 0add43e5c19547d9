"""Maxwell branches: a strip that is pulled and held, and the damping of a mode that rings down."""

import numpy as np

from sheetbench.scenes import Clamped, Held, Material, Motion, Relaxation, Scene, Sheet

BRANCHES = (Relaxation(0.25, 0.02), Relaxation(0.15, 0.3))


def pulled(material: Material, by: float, duration: float) -> Scene:
    """Return a strip whose end is pulled [m] and then held [s]."""
    pull = Motion(time=(0.0, duration), displacement=((0.0, 0.0, 0.0), (by, 0.0, 0.0)))
    supports = (Clamped("x0"), Held("x1", ("x", "y", "z"), motion=pull))
    return Scene("strip", Sheet(0.1, 0.04, 0.002), material, supports=supports, probes={"P": (0.05, 0.0)})


def damping_ratio(swing: np.ndarray, per_period: float) -> float:
    """Return −Re s/|s| of the oscillating pole s of samples (Prony's method, with a decaying part), without
    the first ten."""
    rows = np.lib.stride_tricks.sliding_window_view(swing / swing[0], 6)[10:]
    weights = np.linalg.lstsq(rows[:, :5], rows[:, 5], rcond=1e-10)[0]
    roots = np.roots([1.0, *-weights[::-1]])
    pole = np.log(roots[np.argmin(np.abs(np.angle(roots) - 2.0 * np.pi / per_period))])
    return float(-pole.real / abs(pole))
